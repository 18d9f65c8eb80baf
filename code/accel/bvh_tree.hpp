#pragma once
// What the builders share: an item with its box, and the binary tree that they assemble before it is collapsed and laid
// out depth first.

#include <span>
#include <vector>

#include "accel/box4.hpp"
#include "accel/bvh.hpp"

namespace q3rt {

struct BuildItem {
    Box4 box;
    uint32_t input = 0;
};

/// Good items only (see bvh.hpp); counts the others.
std::vector<BuildItem> collectItems(std::span<const Bounds> items, uint32_t& rejectedCount);

/// A child of a node under construction: a range of items, all that are below it, with its box.
struct BuildChild {
    Box4 box;
    uint32_t first = 0, count = 0; ///< of items
    uint32_t node = 0;             ///< inner child: index in the builder's own node array
    bool leaf = true;
};

struct BuildNode {
    BuildChild child[2];
};

/// Sorts items as a walk through the tree meets them, and tells every child which are its own.
void orderItems(std::vector<BuildNode>& tree, uint32_t root, std::vector<BuildItem>& items);

/// Collapses the tree under `root` to four children a node, lays it out depth first, and fills the rest of the Bvh.
Bvh layOut(const std::vector<BuildNode>& tree, uint32_t root, std::span<const BuildItem> items, uint32_t rejectedCount,
           const BvhBuildSettings& settings);

/// Items that a leaf may have.
inline uint32_t leafLimit(const BvhBuildSettings& settings) {
    return settings.maxLeafItems < 1                   ? 1
           : settings.maxLeafItems > kBvhMostLeafItems ? kBvhMostLeafItems
                                                       : settings.maxLeafItems;
}

/// Splits a range in two for a builder that has no better idea (same centres, too deep): the middle, by order.
inline uint32_t middleOf(uint32_t first, uint32_t count) { return first + count / 2; }

/// Longest path that still leaves room for halving the remaining items to leaves within kBvhMaxDepth.
inline bool mustHalve(uint32_t depth, uint32_t count) {
    uint32_t levels = 0;
    while ((count >> levels) > 1)
        ++levels;
    return depth + levels + 2 >= kBvhMaxDepth;
}

} // namespace q3rt
