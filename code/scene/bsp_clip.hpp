#pragma once
// Polygons and boxes in the tree of a map: in which leafs they lie, and with which part.

#include <functional>
#include <vector>

#include "formats/bsp.hpp"

namespace q3rt {

using Polygon = std::vector<vec3>;

/// Calls `visit` for each leaf that a convex polygon touches, with its part there. With a slack every leaf counts as
/// so much larger: parts overlap.
void visitLeafs(const Bsp& bsp, Polygon polygon, float slackQu,
                const std::function<void(const BspLeaf& leaf, const Polygon& part)>& visit);

/// Boxes that hold all points of each cluster, as the tree tells them apart; infinite where no plane ends a cluster,
/// empty for one that has no leaf. The file's own boxes are rounded to integers.
std::vector<Bounds> boundClusters(const Bsp& bsp);

} // namespace q3rt
