#include "accel/bvh_node.hpp"

#include <algorithm>
#include <cmath>

namespace q3rt {

void setBoxes(BvhNode& node, const Box4 (&box)[kBvhWidth]) {
    for (int axis = 0; axis < 3; ++axis)
        for (int slot = 0; slot < static_cast<int>(kBvhWidth); ++slot) {
            const bool absent = box[slot].mins[0] > box[slot].maxs[0];
            node.bounds[axis][slot] = absent ? 0 : box[slot].mins[axis];
            node.bounds[axis + static_cast<int>(kBvhToHigh)][slot] = absent ? 0 : box[slot].maxs[axis];
        }
}

void setGroups(BvhNode& node, uint32_t slot, uint32_t groups) {
    const uint32_t solid = 1u << slot, other = solid << kBvhWidth;
    node.groups &= ~(solid | other);
    if (groups & kBvhSolidGroup) node.groups |= solid;
    if (groups & kBvhOtherGroup) node.groups |= other;
}

BvhNode packNode(const NodeContent& content) {
    BvhNode node{};
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        node.child[slot] = content.groups[slot] ? content.child[slot] : leafWord(0, 0);
        setGroups(node, slot, content.groups[slot]);
    }
    setBoxes(node, content.box);
    return node;
}

Bounds childBounds(const BvhNode& node, uint32_t slot) {
    Bounds box;
    if (groupsOf(node, slot) == 0) return box;
    const int component = static_cast<int>(slot);
    for (int axis = 0; axis < 3; ++axis) {
        box.mins[axis] = node.bounds[axis][component];
        box.maxs[axis] = node.bounds[axis + static_cast<int>(kBvhToHigh)][component];
    }
    return box;
}

float reachOf(const Bounds& box) {
    float reach = 0;
    for (int axis = 0; axis < 3 && !box.empty(); ++axis)
        reach = std::max({reach, std::abs(box.mins[axis]), std::abs(box.maxs[axis])});
    return reach;
}

} // namespace q3rt
