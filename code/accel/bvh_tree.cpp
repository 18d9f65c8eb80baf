#include "accel/bvh_tree.hpp"

#include <cmath>

#include "accel/bvh_node.hpp"

namespace q3rt {
namespace {

bool isGood(const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.mins[axis] >= -kBvhFarthest && box.maxs[axis] <= kBvhFarthest && box.mins[axis] <= box.maxs[axis]))
            return false;
    return true;
}

/// Four children, or fewer where there are none.
struct WideChildren {
    const BuildChild* child[kBvhWidth]{};
    uint32_t count = 0;
    void add(const BuildChild& c) {
        if (!c.leaf || c.count > 0) child[count++] = &c;
    }
};

/// The two children of a binary node, of which the largest is replaced by its own as long as there is room: the fewer
/// large boxes are left, the fewer visits.
WideChildren collapse(const std::vector<BuildNode>& tree, uint32_t node) {
    WideChildren wide;
    wide.add(tree[node].child[0]);
    wide.add(tree[node].child[1]);
    while (wide.count < kBvhWidth) {
        uint32_t largest = kBvhWidth;
        float area = -1;
        for (uint32_t i = 0; i < wide.count; ++i)
            if (!wide.child[i]->leaf && wide.child[i]->box.halfArea() > area) {
                largest = i;
                area = wide.child[i]->box.halfArea();
            }
        if (largest == kBvhWidth) break;
        const BuildNode& opened = tree[wide.child[largest]->node];
        for (uint32_t i = wide.count++; i > largest + 1; --i)
            wide.child[i] = wide.child[i - 1];
        wide.child[largest] = &opened.child[0];
        wide.child[largest + 1] = &opened.child[1];
    }
    return wide;
}

/// Of a leaf.
uint8_t groupsOfItems(std::span<const BuildItem> items, std::span<const uint8_t> groups) {
    if (groups.empty()) return kBvhSolidGroup | kBvhOtherGroup;
    uint8_t bits = 0;
    for (const BuildItem& item : items)
        bits |= groups[item.input];
    return bits;
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

Bvh layOut(const std::vector<BuildNode>& tree, uint32_t root, std::span<const BuildItem> items, uint32_t rejectedCount,
           std::span<const uint8_t> groups) {
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
    bvh.nodes.reserve(tree.size() / 2 + 1);
    std::vector<Pending> pending{{root, 0, 0}};
    float cost = 0;
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const auto index = static_cast<uint32_t>(bvh.nodes.size());
        if (index > 0) bvh.nodes[next.parent].child[next.slot] = index;
        const WideChildren wide = collapse(tree, next.source);
        NodeContent content;
        for (uint32_t slot = 0; slot < wide.count; ++slot) {
            const BuildChild& child = *wide.child[slot];
            content.box[slot] = child.box;
            content.child[slot] = child.leaf ? leafWord(child.first, child.count) : 0;
            content.groups[slot] = child.leaf ? groupsOfItems(items.subspan(child.first, child.count), groups)
                                              : uint8_t{kBvhSolidGroup | kBvhOtherGroup};
            cost += child.box.halfArea() * (child.leaf ? static_cast<float>(child.count) : 1.0f);
        }
        bvh.nodes.push_back(packNode(content));
        for (uint32_t slot = wide.count; slot-- > 0;)
            if (!wide.child[slot]->leaf) pending.push_back({wide.child[slot]->node, index, slot});
    }
    bvh.nodes[0].reach = reachOf(bvh.bounds);
    if (!groups.empty()) gatherGroups(bvh.nodes);
    bvh.builtCost = 1.0f + (bounds.halfArea() > 0 ? cost / bounds.halfArea() : 0.0f);
    return bvh;
}

} // namespace q3rt
