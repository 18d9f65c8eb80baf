#pragma once
// MD3 (ident IDP3, version 15): vertex-animated models. Offsets and indexes are checked; throws ContentError.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vector.hpp"

namespace q3rt {

inline constexpr float kMd3Step = 1.0f / 64.0f; ///< qu a step of a stored coordinate

struct Md3Frame {
    vec3 mins{0}, maxs{0}, localOrigin{0};
    float radius = 0;
};

struct Md3Tag {
    std::string name;
    Orientation orientation;
};

/// As the file has it: models would take three times the memory as floats.
struct Md3Vertex {
    std::array<int16_t, 3> steps{};
    uint16_t normalCode = 0;
    vec3 position() const { return vec3(steps[0], steps[1], steps[2]) * kMd3Step; } ///< qu
    vec3 normal() const;                                                            ///< unit, by the /1023 sine table
};

struct Md3Surface {
    std::string name; ///< lower case, a trailing "_1" style suffix removed as the engine does
    std::vector<std::string> shaders;
    std::vector<uint32_t> indices; ///< triangles
    std::vector<vec2> st;
    std::vector<Md3Vertex> vertices; ///< frame-major: vertex v of frame f is [f * vertexCount + v]
    size_t vertexCount = 0;
};

struct Md3 {
    std::vector<Md3Frame> frames;
    size_t tagCount = 0;
    std::vector<Md3Tag> tags; ///< frame-major: tag t of frame f is [f * tagCount + t]
    std::vector<Md3Surface> surfaces;
};

Md3 parseMd3(std::span<const std::byte> file, std::string_view name);

} // namespace q3rt
