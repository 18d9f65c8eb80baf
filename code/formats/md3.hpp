#pragma once
// MD3 (ident IDP3, version 15): vertex-animated models. Offsets and indexes are checked; throws ContentError.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vector.hpp"

namespace q3rt {

struct Md3Frame {
    vec3 mins{0}, maxs{0}, localOrigin{0};
    float radius = 0;
};

struct Md3Tag {
    std::string name;
    Orientation orientation;
};

struct Md3Surface {
    std::string name; ///< lower case, a trailing "_1" style suffix removed as the engine does
    std::vector<std::string> shaders;
    std::vector<uint32_t> indices; ///< triangles
    std::vector<vec2> st;
    /// Frame-major: vertex v of frame f is [f * vertexCount + v]. Positions in qu, normals decoded with the /1023 sine
    /// table.
    std::vector<vec3> positions;
    std::vector<vec3> normals;
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
