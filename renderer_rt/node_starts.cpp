#include "renderer_rt/node_starts.hpp"

#include <algorithm>
#include <cmath>

namespace q3rt {

namespace {

constexpr float kLeastCellQu = 64;
constexpr double kMostCells = 1 << 20; ///< 4 MB

struct Box {
    dvec3 center, halfExtent;
};

int32_t deepestAround(const std::vector<RtNode>& nodes, const Box& box) {
    int32_t node = 0;
    while (node >= 0) {
        const RtNode& at = nodes[static_cast<size_t>(node)];
        const dvec3 normal(at.plane.normal);
        const double distance = glm::dot(normal, box.center) - double(at.plane.distance);
        const double reach = glm::dot(glm::abs(normal), box.halfExtent);
        if (std::abs(distance) <= reach) break;
        node = distance > 0 ? at.front : at.back;
    }
    return node;
}

} // namespace

NodeStarts findNodeStarts(const std::vector<RtNode>& nodes, const vec3& mins, const vec3& maxs) {
    NodeStarts result;
    if (nodes.empty()) return result;
    const dvec3 size = glm::max(dvec3(maxs) - dvec3(mins), dvec3(1.0));
    double cell = kLeastCellQu;
    const auto countsAt = [&](double side) { return glm::floor(size / side) + 1.0; };
    const auto cellsAt = [&](double side) { return countsAt(side).x * countsAt(side).y * countsAt(side).z; };
    while (cellsAt(cell) > kMostCells)
        cell *= 2;
    result.origin = mins;
    result.cellQu = static_cast<float>(cell);
    result.counts = ivec3(countsAt(cell));
    // The shader finds a point's cell and its side of a plane with some ten roundings in binary32.
    const dvec3 reach = glm::max(glm::abs(dvec3(mins)), glm::abs(dvec3(maxs))) + size;
    const double rounding = (reach.x + reach.y + reach.z) * 0x1p-20;
    result.starts.reserve(static_cast<size_t>(cellsAt(cell)));
    for (int z = 0; z < result.counts.z; ++z)
        for (int y = 0; y < result.counts.y; ++y)
            for (int x = 0; x < result.counts.x; ++x) {
                const dvec3 center = dvec3(mins) + (dvec3(x, y, z) + 0.5) * cell;
                result.starts.push_back(deepestAround(nodes, {center, dvec3(0.5 * cell + rounding)}));
            }
    return result;
}

} // namespace q3rt
