#pragma once
// A node of four children from their boxes, and back.

#include "accel/box4.hpp"
#include "accel/bvh.hpp"

namespace q3rt {

/// What one node is made of. Absent children have empty boxes.
struct NodeContent {
    Box4 box[kBvhWidth];
    uint32_t child[kBvhWidth]{};
    uint8_t groups[kBvhWidth]{}; ///< 0: absent
};

BvhNode packNode(const NodeContent& content);
/// New boxes for the same children.
void setBoxes(BvhNode& node, const Box4 (&box)[kBvhWidth]);
/// BvhNode::reach of a tree with these bounds.
float reachOf(const Bounds& box);

/// A leaf as BvhNode::child has it.
inline uint32_t leafWord(uint32_t first, uint32_t count) { return kBvhLeafBit | count << kBvhCountShift | first; }
inline uint32_t leafFirst(uint32_t word) { return word & kBvhItemMask; }
inline uint32_t leafCount(uint32_t word) { return (word & ~kBvhLeafBit) >> kBvhCountShift; }
void setGroups(BvhNode& node, uint32_t slot, uint32_t groups);
/// Group bits of a child; 0: there is none.
inline uint32_t groupsOf(const BvhNode& node, uint32_t slot) {
    const uint32_t held = node.groups >> slot;
    return (held & 1u) * kBvhSolidGroup | (held >> kBvhWidth & 1u) * kBvhOtherGroup;
}

} // namespace q3rt
