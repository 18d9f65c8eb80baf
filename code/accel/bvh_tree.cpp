#include "accel/bvh_tree.hpp"

#include <cmath>

namespace q3rt {
namespace {

bool isFinite(const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(box.mins[axis]) || !std::isfinite(box.maxs[axis]) || box.mins[axis] > box.maxs[axis])
            return false;
    return true;
}

/// An empty box: adds nothing to areas and unions.
constexpr float kInverted = std::numeric_limits<float>::max();

void storeChild(BvhNode& node, int side, const BuildChild& child, uint32_t index) {
    const bool absent = child.leaf && child.count == 0;
    const vec3 mins = absent ? vec3(kInverted) : child.box.low();
    const vec3 maxs = absent ? vec3(-kInverted) : child.box.high();
    (side == 0 ? node.leftMins : node.rightMins) = mins;
    (side == 0 ? node.leftMaxs : node.rightMaxs) = maxs;
    (side == 0 ? node.left : node.right) = child.leaf ? kBvhLeafBit | child.first : index;
    (side == 0 ? node.leftCount : node.rightCount) = child.leaf ? child.count : 0;
}

} // namespace

std::vector<BuildItem> collectItems(std::span<const Bounds> items, uint32_t& rejectedCount) {
    std::vector<BuildItem> result;
    result.reserve(items.size());
    rejectedCount = 0;
    for (size_t i = 0; i < items.size(); ++i) {
        if (isFinite(items[i]))
            result.push_back({Box4(items[i]), static_cast<uint32_t>(i)});
        else
            ++rejectedCount;
    }
    return result;
}

Bvh layOut(const std::vector<BuildNode>& tree, uint32_t root, std::span<const BuildItem> items,
           uint32_t rejectedCount) {
    Bvh bvh;
    bvh.rejectedCount = rejectedCount;
    bvh.order.reserve(items.size());
    Box4 bounds;
    for (const BuildItem& item : items) {
        bvh.order.push_back(item.input);
        bounds.add(item.box);
    }
    if (!items.empty()) bvh.bounds = {bounds.low(), bounds.high()};

    struct Pending {
        uint32_t source;
        uint32_t parent; // in bvh.nodes
        int side;        // -1: the root
    };
    bvh.nodes.reserve(tree.size());
    std::vector<Pending> pending{{root, 0, -1}};
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const auto index = static_cast<uint32_t>(bvh.nodes.size());
        if (next.side >= 0) (next.side == 0 ? bvh.nodes[next.parent].left : bvh.nodes[next.parent].right) = index;
        const BuildNode& source = tree[next.source];
        BvhNode node{};
        for (int side = 0; side < 2; ++side)
            storeChild(node, side, source.child[side], 0);
        bvh.nodes.push_back(node);
        for (int side = 1; side >= 0; --side)
            if (!source.child[side].leaf) pending.push_back({source.child[side].node, index, side});
    }
    return bvh;
}

} // namespace q3rt
