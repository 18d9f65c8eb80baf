#pragma once
// What the builders share: an item with its box, and the tree they assemble before it is laid out depth first.

#include <span>
#include <vector>

#include "accel/box4.hpp"
#include "accel/bvh.hpp"

namespace q3rt {

struct BuildItem {
    Box4 box;
    uint32_t input = 0;
};

/// Finite items only; counts the others.
std::vector<BuildItem> collectItems(std::span<const Bounds> items, uint32_t& rejectedCount);

/// A child of a node under construction: a range of items with its box.
struct BuildChild {
    Box4 box;
    uint32_t first = 0, count = 0; ///< of items
    uint32_t node = 0;             ///< inner child: index in the builder's own node array
    bool leaf = true;
};

struct BuildNode {
    BuildChild child[2];
};

/// Copies the tree under `root` depth first, near memory order of traversal, and fills Bvh::order and bounds.
Bvh layOut(const std::vector<BuildNode>& tree, uint32_t root, std::span<const BuildItem> items, uint32_t rejectedCount);

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
