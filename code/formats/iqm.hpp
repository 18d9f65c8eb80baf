#pragma once
// IQM (INTERQUAKEMODEL, version 2): models with a skeleton whose frames store what moves of each joint. Counts, offsets
// and indexes are checked; throws ContentError.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vector.hpp"

namespace q3rt {

struct IqmMesh {
    std::string name; ///< lower case
    std::string material;
    uint32_t firstVertex = 0, vertexCount = 0;
    std::vector<uint32_t> indices; ///< triangles, from firstVertex on
};

/// Place of a joint in its parent: quaternion x y z w of length 1.
struct IqmTransform {
    vec3 translate{0};
    vec4 rotate{0, 0, 0, -1};
    vec3 scale{1};
};

struct IqmJoint {
    std::string name;
    int parent = -1; ///< an earlier joint, -1 none
    IqmTransform bind;
};

/// How a joint's ten channels (translate, rotate, scale) come out of a frame's data.
struct IqmPose {
    uint32_t mask = 0; ///< bit k: channel k is stored
    std::array<float, 10> offset{}, scale{};
    uint32_t firstChannel = 0; ///< in a frame's data
};

struct Iqm {
    std::vector<IqmMesh> meshes;
    std::vector<vec3> positions, normals; ///< of all meshes
    std::vector<vec2> st;
    std::vector<std::array<uint8_t, 4>> colors;       ///< empty: none
    std::vector<std::array<uint8_t, 4>> blendIndexes; ///< joints; empty without a skeleton
    std::vector<vec4> blendWeights;                   ///< as in the file, [0, 1] where stored as bytes
    std::vector<IqmJoint> joints;
    std::vector<IqmPose> poses; ///< none, or one a joint
    size_t frameCount = 0;
    std::vector<uint16_t> channels; ///< frame-major
    size_t channelCount = 0;        ///< of a frame
    std::vector<Bounds> bounds;     ///< one a frame, or none

    /// Joint `joint` at `frame`.
    IqmTransform poseAt(size_t frame, size_t joint) const;
};

Iqm parseIqm(std::span<const std::byte> file, std::string_view name);

} // namespace q3rt
