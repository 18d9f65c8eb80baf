// Closest-centroid pairing, bottom up, level by level (Park and Baek 2021, "A Shader-Based Ray Tracing Engine", section
// 3.1). Kept as the baseline that the other builders are measured against; nothing draws with it.

#include <algorithm>

#include "accel/bvh_tree.hpp"

namespace q3rt {
namespace {

float squaredDistance(Float4 a, Float4 b) {
    const Float4 d = a - b;
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

/// Index of the child after `i` whose centre is closest to that of `i`.
size_t closestAfter(const std::vector<BuildChild>& level, const std::vector<bool>& taken, size_t i) {
    size_t best = level.size();
    float bestDistance = std::numeric_limits<float>::max();
    for (size_t j = i + 1; j < level.size(); ++j) {
        if (taken[j]) continue;
        const float distance = squaredDistance(level[i].box.doubleCentre(), level[j].box.doubleCentre());
        if (best == level.size() || distance < bestDistance) {
            best = j;
            bestDistance = distance;
        }
    }
    return best;
}

} // namespace

Bvh buildPairing(std::span<const Bounds> boxes) {
    uint32_t rejected = 0;
    std::vector<BuildItem> items = collectItems(boxes, rejected);
    std::vector<BuildNode> tree;
    std::vector<BuildChild> level;
    for (uint32_t i = 0; i < items.size(); ++i)
        level.push_back({items[i].box, i, 1, 0, true});
    while (level.size() > 1) {
        std::vector<BuildChild> next;
        std::vector<bool> taken(level.size(), false);
        for (size_t i = 0; i < level.size(); ++i) {
            if (taken[i]) continue;
            const size_t partner = closestAfter(level, taken, i);
            if (partner == level.size()) {
                next.push_back(level[i]);
                continue;
            }
            taken[partner] = true;
            BuildChild parent{level[i].box, 0, 0, static_cast<uint32_t>(tree.size()), false};
            parent.box.add(level[partner].box);
            tree.push_back({{level[i], level[partner]}});
            next.push_back(parent);
        }
        level.swap(next);
    }
    uint32_t root = 0;
    if (level.empty() || level[0].leaf) {
        tree.emplace_back();
        if (!level.empty()) tree[0].child[0] = level[0];
    } else {
        root = level[0].node;
    }
    orderItems(tree, root, items);
    return layOut(tree, root, items, rejected, {});
}

} // namespace q3rt
