// MDR: bones whose matrices every frame stores.

#include <algorithm>

#include "scene/animated_mesh.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr uint32_t kWhite = 0xffffffffu; // MDR carries no colours

class MdrMesh : public AnimatedMesh {
  public:
    MdrMesh(std::shared_ptr<const Mdr> model, size_t level)
        : m_model(std::move(model))
        , m_surfaces(m_model->lods[level]) {}

    size_t frameCount() const override { return m_model->frames.size(); }
    FrameBox frameBox(int frame) const override {
        const MdrFrame& box = m_model->frames[static_cast<size_t>(frame)];
        return {{box.mins, box.maxs}, box.localOrigin, box.radius};
    }
    bool lerpTag(std::string_view name, int startFrame, int endFrame, float fraction, Orientation& out) const override;
    size_t surfaceCount() const override { return m_surfaces.size(); }
    MeshSurface surface(size_t surface) const override {
        return {m_surfaces[surface].name, {m_surfaces[surface].shader}};
    }
    size_t vertexCount(size_t surface) const override { return m_surfaces[surface].vertices.size(); }
    std::span<const uint32_t> indices(size_t surface) const override { return m_surfaces[surface].indices; }
    void pose(const FramePair& frames, std::vector<Affine>& bones) const override;
    void appendVertices(size_t surface, const FramePair& frames, std::span<const Affine> bones,
                        std::vector<Vertex>& out) const override;

  private:
    const Affine& bone(int frame, size_t bone) const {
        return m_model->bones[static_cast<size_t>(frame) * m_model->boneCount + bone];
    }
    std::shared_ptr<const Mdr> m_model;
    const std::vector<MdrSurface>& m_surfaces;
};

bool MdrMesh::lerpTag(std::string_view name, int startFrame, int endFrame, float fraction, Orientation& out) const {
    const auto tag = std::ranges::find(m_model->tags, name, &MdrTag::name);
    if (tag == m_model->tags.end()) return false;
    const int last = static_cast<int>(frameCount()) - 1;
    const Affine blended = bone(std::clamp(startFrame, 0, last), tag->bone) * (1.0f - fraction) +
                           bone(std::clamp(endFrame, 0, last), tag->bone) * fraction;
    out.origin = blended.column(3);
    for (int i = 0; i < 3; ++i)
        out.axis[i] = normalizeOrZero(blended.column(i));
    return true;
}

/// Blended element by element: halfway through a turn a bone is thinner, as content was made to look.
void MdrMesh::pose(const FramePair& frames, std::vector<Affine>& bones) const {
    bones.clear();
    for (size_t i = 0; i < m_model->boneCount; ++i) {
        if (frames.backLerp == 0.0f)
            bones.push_back(bone(frames.frame, i));
        else
            bones.push_back(bone(frames.oldFrame, i) * frames.backLerp +
                            bone(frames.frame, i) * (1.0f - frames.backLerp));
    }
}

void MdrMesh::appendVertices(size_t index, const FramePair&, std::span<const Affine> bones,
                             std::vector<Vertex>& out) const {
    const MdrSurface& surface = m_surfaces[index];
    for (const MdrVertex& vertex : surface.vertices) {
        Vertex result{};
        for (uint32_t i = 0; i < vertex.weightCount; ++i) {
            const MdrWeight& weight = surface.weights[vertex.firstWeight + i];
            const Affine& of = bones[weight.bone];
            result.position += of.point(weight.offset) * weight.weight;
            result.normal += of.vector(vertex.normal) * weight.weight;
        }
        result.st = vertex.st;
        result.color = kWhite;
        out.push_back(result);
    }
}

} // namespace

std::unique_ptr<AnimatedMesh> makeMdrMesh(std::shared_ptr<const Mdr> model, size_t level) {
    return std::make_unique<MdrMesh>(std::move(model), level);
}

} // namespace q3rt
