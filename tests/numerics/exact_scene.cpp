#include "numerics/exact_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "accel/bvh_node.hpp"

namespace q3rt::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::vector<Bounds> boundsOf(const std::vector<dvec3>& corners) {
    std::vector<Bounds> boxes;
    for (size_t i = 0; i < corners.size(); i += 3) {
        Bounds box;
        for (size_t k = 0; k < 3; ++k)
            for (const float towards : {-kInfinity, kInfinity}) {
                vec3 rounded;
                for (int axis = 0; axis < 3; ++axis)
                    rounded[axis] = std::nextafter(static_cast<float>(corners[i + k][axis]), towards);
                box.add(rounded);
            }
        boxes.push_back(box);
    }
    return boxes;
}

bool meetsBox(const vec3& mins, const vec3& maxs, const dvec3& origin, const dvec3& reciprocal, double tMin,
              double tMax) {
    const dvec3 one = (dvec3(mins) - origin) * reciprocal, other = (dvec3(maxs) - origin) * reciprocal;
    const dvec3 enter = glm::min(one, other), leave = glm::max(one, other);
    return std::max({enter.x, enter.y, enter.z, tMin}) <= std::min({leave.x, leave.y, leave.z, tMax}) * (1 + 1e-14);
}

} // namespace

ExactScene::ExactScene(std::vector<dvec3> corners)
    : m_corners(std::move(corners))
    , m_bvh(buildSah(boundsOf(m_corners))) {}

bool ExactScene::meets(size_t triangle, const dvec3& origin, const dvec3& direction, double tMin, double tMax) const {
    // Cramer's rule on origin + t direction = a + u (b - a) + v (c - a).
    const dvec3 a = m_corners[3 * triangle];
    const dvec3 edge1 = m_corners[3 * triangle + 1] - a, edge2 = m_corners[3 * triangle + 2] - a;
    const dvec3 across = glm::cross(direction, edge2), from = origin - a;
    const double determinant = glm::dot(edge1, across);
    if (determinant == 0) return false;
    const dvec3 side = glm::cross(from, edge1);
    const double u = glm::dot(from, across) / determinant, v = glm::dot(direction, side) / determinant;
    const double t = glm::dot(edge2, side) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > tMin && t < tMax;
}

bool ExactScene::isHit(const dvec3& origin, const dvec3& direction, double tMin, double tMax) const {
    const dvec3 reciprocal = 1.0 / direction;
    std::vector<uint32_t> open{0};
    while (!open.empty()) {
        const BvhNode& node = m_bvh.nodes[open.back()];
        open.pop_back();
        for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
            const Bounds box = childBounds(node, slot);
            if (box.empty() || !meetsBox(box.mins, box.maxs, origin, reciprocal, tMin, tMax)) continue;
            const uint32_t child = node.child[slot];
            if ((child & kBvhLeafBit) == 0) {
                open.push_back(child);
                continue;
            }
            for (uint32_t i = 0; i < leafCount(child); ++i)
                if (meets(m_bvh.order[leafFirst(child) + i], origin, direction, tMin, tMax)) return true;
        }
    }
    return false;
}

} // namespace q3rt::test
