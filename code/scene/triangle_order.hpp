#pragma once
// Order of triangles and instances for acceleration structures that follow primitive order (lavapipe's does: 1.8 to 4
// times faster traversal in this order than in file order).

#include <cstdint>
#include <span>
#include <vector>

#include "math/vector.hpp"

namespace q3rt {

/// Returns the permutation: entry i is the box that comes i-th, the leaf order of a binned surface-area-heuristic tree.
/// Flat and huge boxes are fine; those that are not finite come last.
std::vector<uint32_t> sahLeafOrder(std::span<const Bounds> boxes, uint32_t maxLeafItems);

/// The same of triangles, three positions each.
std::vector<uint32_t> sahLeafOrder(std::span<const vec3> trianglePositions);

} // namespace q3rt
