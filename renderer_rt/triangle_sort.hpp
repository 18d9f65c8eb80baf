#pragma once
// Triangles of an index list in the order that acceleration structures like best.

#include <numeric>
#include <span>
#include <vector>

#include "scene/triangle_order.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

/// As few are a leaf in any order.
inline constexpr size_t kFewTriangles = 4;

/// Permutation of the triangles of `indices` (absolute in `vertices`): entry i is the triangle that comes i-th.
inline std::vector<uint32_t> sortTriangles(std::span<const Vertex> vertices, std::span<const uint32_t> indices) {
    if (indices.size() <= 3 * kFewTriangles) {
        std::vector<uint32_t> asTheyAre(indices.size() / 3);
        std::iota(asTheyAre.begin(), asTheyAre.end(), 0u);
        return asTheyAre;
    }
    std::vector<vec3> positions;
    positions.reserve(indices.size());
    for (const uint32_t index : indices)
        positions.push_back(vertices[index].position);
    return sahLeafOrder(positions);
}

} // namespace q3rt
