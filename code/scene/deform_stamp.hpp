#pragma once
// The square that sprites, autosprites and rail rings are made of.

#include <vector>

#include "shaders/shared/vertex.h"

namespace q3rt {

struct Stamp {
    vec3 centre{0}, left{0}, up{0}; ///< corners are centre +- left +- up
    vec3 normal{0};
    uint32_t color = 0xffffffffu;
    vec2 stFirst{0.0f}, stLast{1.0f}; ///< at left + up, at -left - up
};

/// Appends 4 vertices and 6 indices; indices count from the start of `vertices`.
inline void appendStamp(const Stamp& stamp, std::vector<Vertex>& vertices, std::vector<uint32_t>& indices) {
    const auto first = static_cast<uint32_t>(vertices.size());
    const auto corner = [&](float left, float up, const vec2& st) {
        vertices.push_back({stamp.centre + stamp.left * left + stamp.up * up, stamp.normal, st, st, stamp.color, 0});
    };
    corner(1, 1, stamp.stFirst);
    corner(-1, 1, {stamp.stLast.x, stamp.stFirst.y});
    corner(-1, -1, stamp.stLast);
    corner(1, -1, {stamp.stFirst.x, stamp.stLast.y});
    for (const uint32_t offset : {0u, 1u, 3u, 3u, 1u, 2u}) {
        indices.push_back(first + offset);
    }
}

} // namespace q3rt
