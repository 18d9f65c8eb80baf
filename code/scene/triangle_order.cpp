#include "scene/triangle_order.hpp"

#include "accel/bvh.hpp"

namespace q3rt {

std::vector<uint32_t> sahLeafOrder(std::span<const Bounds> boxes, uint32_t maxLeafItems) {
    std::vector<uint32_t> order = buildSah(boxes, {.maxLeafItems = maxLeafItems}).order;
    if (order.size() == boxes.size()) return order;
    std::vector<bool> inTree(boxes.size(), false);
    for (const uint32_t item : order)
        inTree[item] = true;
    for (uint32_t item = 0; item < boxes.size(); ++item)
        if (!inTree[item]) order.push_back(item);
    return order;
}

std::vector<uint32_t> sahLeafOrder(std::span<const vec3> trianglePositions) {
    return sahLeafOrder(triangleBounds(trianglePositions), BvhBuildSettings{}.maxLeafItems);
}

} // namespace q3rt
