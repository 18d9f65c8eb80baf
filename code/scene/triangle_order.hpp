#pragma once
// Order of triangles for acceleration structures that follow primitive order (lavapipe's does: 1.8 to 4 times faster
// traversal in this order than in file order).

#include <cstdint>
#include <span>
#include <vector>

#include "math/vector.hpp"

namespace q3rt {

/// Three positions a triangle. Returns the permutation: entry i is the triangle that comes i-th, the leaf order of a
/// binned surface-area-heuristic tree. Zero-area and huge triangles are fine; those with non-finite corners come last.
std::vector<uint32_t> sahLeafOrder(std::span<const vec3> trianglePositions);

} // namespace q3rt
