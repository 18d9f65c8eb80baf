#pragma once
// MDR (ident RDM5, version 2): models with bones, whose frames store each bone's matrix, plain or in 16-bit steps.
// Counts, offsets and indexes are checked; throws ContentError.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/affine.hpp"

namespace q3rt {

struct MdrFrame {
    vec3 mins{0}, maxs{0}, localOrigin{0};
    float radius = 0;
};

struct MdrWeight {
    uint32_t bone = 0;
    float weight = 0;
    vec3 offset{0}; ///< of the vertex in the bone's space
};

struct MdrVertex {
    vec3 normal{0};
    vec2 st{0};
    uint32_t firstWeight = 0, weightCount = 0; ///< in MdrSurface::weights
};

struct MdrSurface {
    std::string name; ///< lower case
    std::string shader;
    std::vector<MdrVertex> vertices;
    std::vector<MdrWeight> weights;
    std::vector<uint32_t> indices; ///< triangles
};

struct MdrTag {
    std::string name;
    uint32_t bone = 0;
};

struct Mdr {
    std::vector<MdrFrame> frames;
    size_t boneCount = 0;
    std::vector<Affine> bones;                 ///< frame-major: bone b of frame f is [f * boneCount + b]
    std::vector<std::vector<MdrSurface>> lods; ///< surfaces of each level of detail, [0] finest
    std::vector<MdrTag> tags;
};

Mdr parseMdr(std::span<const std::byte> file, std::string_view name);

} // namespace q3rt
