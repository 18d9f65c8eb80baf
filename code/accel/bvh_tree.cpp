#include "accel/bvh_tree.hpp"

#include <cmath>

#include "accel/bvh_collapse.hpp"
#include "accel/bvh_node.hpp"

namespace q3rt {
namespace {

bool isGood(const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.mins[axis] >= -kBvhFarthest && box.maxs[axis] <= kBvhFarthest && box.mins[axis] <= box.maxs[axis]))
            return false;
    return true;
}

/// Of a leaf.
uint8_t groupsOfItems(std::span<const BuildItem> items, std::span<const uint8_t> groups) {
    if (groups.empty()) return kBvhSolidGroup | kBvhOtherGroup;
    uint8_t bits = 0;
    for (const BuildItem& item : items)
        bits |= groups[item.input];
    return bits;
}

void placeItems(std::vector<BuildNode>& tree, BuildChild& child, std::span<const BuildItem> items,
                std::vector<BuildItem>& placed) {
    const auto first = static_cast<uint32_t>(placed.size());
    if (child.leaf) {
        const auto own = items.subspan(child.first, child.count);
        placed.insert(placed.end(), own.begin(), own.end());
    } else {
        for (BuildChild& below : tree[child.node].child)
            placeItems(tree, below, items, placed);
    }
    child.first = first;
    child.count = static_cast<uint32_t>(placed.size()) - first;
}

/// A parent's bits for its inner children, which stand behind it.
void gatherGroups(std::vector<BvhNode>& nodes) {
    for (size_t i = nodes.size(); i-- > 0;)
        for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
            if (nodes[i].child[slot] & kBvhLeafBit) continue;
            uint32_t below = 0;
            for (uint32_t inner = 0; inner < kBvhWidth; ++inner)
                below |= groupsOf(nodes[nodes[i].child[slot]], inner);
            setGroups(nodes[i], slot, below);
        }
}

} // namespace

std::vector<BuildItem> collectItems(std::span<const Bounds> items, uint32_t& rejectedCount) {
    std::vector<BuildItem> result;
    result.reserve(items.size());
    rejectedCount = 0;
    for (size_t i = 0; i < items.size(); ++i) {
        if (isGood(items[i]))
            result.push_back({Box4(items[i]), static_cast<uint32_t>(i)});
        else
            ++rejectedCount;
    }
    return result;
}

void orderItems(std::vector<BuildNode>& tree, uint32_t root, std::vector<BuildItem>& items) {
    std::vector<BuildItem> placed;
    placed.reserve(items.size());
    for (BuildChild& child : tree[root].child)
        placeItems(tree, child, items, placed);
    items.swap(placed);
}

Bvh layOut(const std::vector<BuildNode>& tree, uint32_t root, std::span<const BuildItem> items, uint32_t rejectedCount,
           const BvhBuildSettings& settings) {
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
        uint32_t parent, slot; // in bvh.nodes; the root's are never read
    };
    const Collapse collapse(tree, root, settings);
    bvh.nodes.reserve(tree.size() / 2 + 1);
    std::vector<Pending> pending{{root, 0, 0}};
    float cost = 0;
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const auto index = static_cast<uint32_t>(bvh.nodes.size());
        if (index > 0) bvh.nodes[next.parent].child[next.slot] = index;
        const WideChildren wide = collapse.childrenOf(next.source);
        NodeContent content;
        for (uint32_t slot = 0; slot < wide.count; ++slot) {
            const auto& [child, leaf] = wide.child[slot];
            content.box[slot] = child->box;
            content.groups[slot] = kBvhSolidGroup | kBvhOtherGroup;
            if (leaf) {
                content.child[slot] = leafWord(child->first, child->count);
                content.groups[slot] = groupsOfItems(items.subspan(child->first, child->count), settings.groups);
            }
            cost += child->box.halfArea() * (leaf ? static_cast<float>(child->count) : 1.0f);
        }
        bvh.nodes.push_back(packNode(content));
        for (uint32_t slot = wide.count; slot-- > 0;)
            if (!wide.child[slot].leaf) pending.push_back({wide.child[slot].source->node, index, slot});
    }
    bvh.nodes[0].reach = reachOf(bvh.bounds);
    if (!settings.groups.empty()) gatherGroups(bvh.nodes);
    bvh.builtCost = 1.0f + (bounds.halfArea() > 0 ? cost / bounds.halfArea() : 0.0f);
    return bvh;
}

} // namespace q3rt
