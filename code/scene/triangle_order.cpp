#include "scene/triangle_order.hpp"

#include "accel/bvh.hpp"

namespace q3rt {

std::vector<uint32_t> sahLeafOrder(std::span<const vec3> trianglePositions) {
    const std::vector<Bounds> boxes = triangleBounds(trianglePositions);
    std::vector<uint32_t> order = buildSah(boxes).order;
    if (order.size() == boxes.size()) return order;
    std::vector<bool> inTree(boxes.size(), false);
    for (const uint32_t triangle : order)
        inTree[triangle] = true;
    for (uint32_t triangle = 0; triangle < boxes.size(); ++triangle)
        if (!inTree[triangle]) order.push_back(triangle);
    return order;
}

} // namespace q3rt
