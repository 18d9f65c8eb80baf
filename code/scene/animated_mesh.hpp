#pragma once
// A mesh model of any file format at any pair of its frames: boxes, tags, vertices (spec of models, 2.2, 2.3 and 3).

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/iqm.hpp"
#include "formats/md3.hpp"
#include "formats/mdr.hpp"
#include "math/affine.hpp"
#include "math/lanes.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

/// Two frames of a mesh, both valid, and the weight of the old one; 0 where they are the same.
struct FramePair {
    int frame = 0, oldFrame = 0;
    float backLerp = 0;
};

/// Extent of a frame, model space.
struct FrameBox {
    Bounds box; ///< empty: not known
    vec3 centre{0};
    float radius = 0; ///< of the sphere around `centre`
};

struct MeshSurface {
    std::string name;                 ///< lower case
    std::vector<std::string> shaders; ///< by skin number
};

class AnimatedMesh {
  public:
    virtual ~AnimatedMesh() = default;
    virtual size_t frameCount() const = 0; ///< at least 1
    virtual FrameBox frameBox(int frame) const = 0;
    /// Origin and axes of a tag or joint; false if there is none of that name. `fraction` weights `endFrame`; frames
    /// beyond the last one are the last one.
    virtual bool lerpTag(std::string_view name, int startFrame, int endFrame, float fraction,
                         Orientation& out) const = 0;
    virtual size_t surfaceCount() const = 0;
    virtual MeshSurface surface(size_t surface) const = 0;
    virtual size_t vertexCount(size_t surface) const = 0;
    /// Of the vertices at a pair of frames; empty: not known.
    virtual Bounds surfaceBox(size_t, const FramePair&) const { return {}; }
    virtual std::span<const uint32_t> indices(size_t surface) const = 0; ///< triangles
    /// Bones at a pair of frames, for appendVertices(); nothing for meshes without bones.
    virtual void pose(const FramePair& frames, std::vector<Affine>& bones) const = 0;
    virtual void appendVertices(size_t surface, const FramePair& frames, std::span<const Affine> bones,
                                std::vector<Vertex>& out) const = 0;
    /// Only where the vertices are, the fourth of each number means nothing; false where all of a vertex is no more
    /// work.
    virtual bool findPositions(size_t, const FramePair&, std::vector<Float4>&) const { return false; }
    /// The vertices of these numbers, where findPositions() knows their places.
    virtual void appendSome(size_t, const FramePair&, std::span<const uint32_t>, std::vector<Vertex>&) const {}
};

std::unique_ptr<AnimatedMesh> makeMd3Mesh(Md3 model);
/// One level of detail of the model.
std::unique_ptr<AnimatedMesh> makeMdrMesh(std::shared_ptr<const Mdr> model, size_t level);
std::unique_ptr<AnimatedMesh> makeIqmMesh(Iqm model);

} // namespace q3rt
