#include <algorithm>

#include "accel/bvh_node.hpp"

namespace q3rt {
namespace {

float halfArea(const Bounds& box) {
    const vec3 size = box.maxs - box.mins;
    return size.x < 0 ? 0 : size.x * size.y + size.y * size.z + size.z * size.x;
}

} // namespace

float surfaceAreaCost(const Bvh& bvh, float traversalCost) {
    const float rootArea = bvh.bounds.empty() ? 0 : halfArea(bvh.bounds);
    if (rootArea <= 0) return traversalCost;
    double cost = traversalCost;
    for (const BvhNode& node : bvh.nodes)
        for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
            const double share = halfArea(childBounds(node, slot)) / rootArea;
            const uint32_t child = node.child[slot];
            cost += share * ((child & kBvhLeafBit) ? static_cast<float>(leafCount(child)) : traversalCost);
        }
    return static_cast<float>(cost);
}

uint32_t depthOf(const Bvh& bvh) {
    // A parent stands before its children, so one forward pass knows every depth.
    std::vector<uint32_t> depth(bvh.nodes.size(), 1);
    uint32_t deepest = 1;
    for (size_t i = 0; i < bvh.nodes.size(); ++i) {
        deepest = std::max(deepest, depth[i]);
        for (const uint32_t child : bvh.nodes[i].child)
            if (!(child & kBvhLeafBit)) depth[child] = depth[i] + 1;
    }
    return deepest;
}

std::optional<float> refit(Bvh& bvh, std::span<const BvhTriangle> triangles) {
    std::vector<Box4> whole(bvh.nodes.size());
    float cost = 0;
    Float4 odd{}; // becomes NaN with the first corner that is not finite
    // Children stand behind their parent: backwards, every child is ready.
    for (size_t i = bvh.nodes.size(); i-- > 0;) {
        BvhNode& node = bvh.nodes[i];
        Box4 box[kBvhWidth];
        for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
            const uint32_t child = node.child[slot];
            const bool leaf = (child & kBvhLeafBit) != 0;
            if (leaf) {
                for (const BvhTriangle& triangle : triangles.subspan(leafFirst(child), leafCount(child)))
                    for (const vec3& corner : {triangle.corner0, triangle.corner1, triangle.corner2}) {
                        const Float4 point{corner.x, corner.y, corner.z, 0};
                        box[slot].addPoint(point);
                        odd += point - point;
                    }
            } else {
                box[slot] = whole[child];
            }
            cost += box[slot].halfArea() * (leaf ? static_cast<float>(leafCount(child)) : 1.0f);
            whole[i].add(box[slot]);
        }
        setBoxes(node, box);
    }
    bvh.bounds = {};
    if (!triangles.empty()) bvh.bounds = {whole[0].low(), whole[0].high()};
    bvh.nodes[0].reach = reachOf(bvh.bounds);
    if (odd[0] != 0 || odd[1] != 0 || odd[2] != 0 || bvh.nodes[0].reach > kBvhFarthest) return std::nullopt;
    const float area = whole[0].halfArea();
    return (1.0f + (area > 0 ? cost / area : 0.0f)) / bvh.builtCost;
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
                                       std::span<const TriangleLabel> labels) {
    std::vector<BvhTriangle> triangles;
    triangles.reserve(bvh.order.size());
    for (const uint32_t triangle : bvh.order) {
        const vec3* corner = &positions[3 * size_t{triangle}];
        const TriangleLabel label = labels.empty() ? TriangleLabel{.number = triangle} : labels[triangle];
        triangles.push_back({corner[0], label.number, corner[1], label.flags, corner[2], 0});
    }
    return triangles;
}

BvhInstance instanceInPlace(uint64_t nodes, uint64_t triangles, uint32_t mask) {
    BvhInstance instance{};
    for (int row = 0; row < 3; ++row)
        instance.modelFromWorld[row][row] = 1;
    instance.nodes = nodes;
    instance.triangles = triangles;
    instance.mask = mask | kBvhInPlace;
    for (uint32_t& masks : instance.partMasks)
        masks = 0x01010101u * mask;
    return instance;
}

} // namespace q3rt
