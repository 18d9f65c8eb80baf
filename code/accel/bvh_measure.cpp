#include <algorithm>

#include "accel/bvh_tree.hpp"

namespace q3rt {
namespace {

float halfArea(const vec3& mins, const vec3& maxs) {
    const vec3 size = maxs - mins;
    return size.x < 0 ? 0 : size.x * size.y + size.y * size.z + size.z * size.x;
}

} // namespace

float surfaceAreaCost(const Bvh& bvh, float traversalCost) {
    const float rootArea = bvh.bounds.empty() ? 0 : halfArea(bvh.bounds.mins, bvh.bounds.maxs);
    if (rootArea <= 0) return traversalCost;
    double cost = traversalCost;
    for (const BvhNode& node : bvh.nodes) {
        const double left = halfArea(node.leftMins, node.leftMaxs) / rootArea;
        const double right = halfArea(node.rightMins, node.rightMaxs) / rootArea;
        cost += left * ((node.left & kBvhLeafBit) ? static_cast<float>(node.leftCount) : traversalCost);
        cost += right * ((node.right & kBvhLeafBit) ? static_cast<float>(node.rightCount) : traversalCost);
    }
    return static_cast<float>(cost);
}

uint32_t depthOf(const Bvh& bvh) {
    // Depth-first layout: a parent stands before its children, so one forward pass knows every depth.
    std::vector<uint32_t> depth(bvh.nodes.size(), 1);
    uint32_t deepest = 1;
    for (size_t i = 0; i < bvh.nodes.size(); ++i) {
        deepest = std::max(deepest, depth[i]);
        for (const uint32_t child : {bvh.nodes[i].left, bvh.nodes[i].right})
            if (!(child & kBvhLeafBit)) depth[child] = depth[i] + 1;
    }
    return deepest;
}

float refit(Bvh& bvh, std::span<const Bounds> items) {
    const float before = surfaceAreaCost(bvh);
    const auto boxOf = [&](uint32_t child, uint32_t count) {
        Bounds box;
        if (child & kBvhLeafBit) {
            for (uint32_t i = 0; i < count; ++i)
                box.add(items[bvh.order[(child & ~kBvhLeafBit) + i]]);
        } else {
            const BvhNode& node = bvh.nodes[child];
            box.add(Bounds{node.leftMins, node.leftMaxs});
            box.add(Bounds{node.rightMins, node.rightMaxs});
        }
        return box;
    };
    // Children stand after their parent: backwards, every child is ready.
    for (size_t i = bvh.nodes.size(); i-- > 0;) {
        BvhNode& node = bvh.nodes[i];
        const Bounds left = boxOf(node.left, node.leftCount), right = boxOf(node.right, node.rightCount);
        node.leftMins = left.mins;
        node.leftMaxs = left.maxs;
        node.rightMins = right.mins;
        node.rightMaxs = right.maxs;
    }
    bvh.bounds = {};
    bvh.bounds.add(Bounds{bvh.nodes[0].leftMins, bvh.nodes[0].leftMaxs});
    bvh.bounds.add(Bounds{bvh.nodes[0].rightMins, bvh.nodes[0].rightMaxs});
    return surfaceAreaCost(bvh) / before;
}

std::vector<Bounds> triangleBounds(std::span<const vec3> positions) {
    std::vector<Bounds> boxes(positions.size() / 3);
    for (size_t i = 0; i < boxes.size(); ++i) {
        const vec3 &a = positions[3 * i], &b = positions[3 * i + 1], &c = positions[3 * i + 2];
        // A NaN corner must not vanish in min(): the sum carries it into the box, which is then rejected.
        boxes[i] = {glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)};
        const vec3 sum = a + b + c;
        for (int axis = 0; axis < 3; ++axis)
            if (!(sum[axis] - sum[axis] == 0)) boxes[i].mins[axis] = std::numeric_limits<float>::quiet_NaN();
    }
    return boxes;
}

std::vector<BvhTriangle> leafTriangles(const Bvh& bvh, std::span<const vec3> positions,
                                       std::span<const uint8_t> opaque) {
    std::vector<BvhTriangle> triangles;
    triangles.reserve(bvh.order.size());
    for (const uint32_t number : bvh.order) {
        const vec3* corner = &positions[3 * size_t{number}];
        triangles.push_back({corner[0], number, corner[1], opaque.empty() ? 1u : opaque[number], corner[2], 0});
    }
    return triangles;
}

} // namespace q3rt
