#pragma once
// Makes a finished binary tree better: subtrees are taken out and put where they cost least (Meister and Bittner 2018,
// "Parallel Reinsertion for Bounding Volume Hierarchy Optimization", sections 3.1 and 3.2, here one after the other;
// which ones, as Bittner, Hapala and Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies").

#include "accel/bvh_tree.hpp"

namespace q3rt {

/// Moves subtrees where that lessens the sum of all inner nodes' areas. Leaves and the root stay what they are; items
/// are sorted anew. A tree that would become deeper than kBvhMaxDepth is left as it was.
void reinsertSubtrees(std::vector<BuildNode>& tree, uint32_t root, std::vector<BuildItem>& items);

} // namespace q3rt
