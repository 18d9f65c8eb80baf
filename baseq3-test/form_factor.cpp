#include "baseq3-test/form_factor.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace q3rt {

namespace {

/// The part of the polygon with dot(normal, vertex) >= 0; vertices relative to the element.
std::vector<dvec3> clipToHorizon(const std::vector<dvec3>& polygon, const dvec3& normal) {
    std::vector<dvec3> clipped;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
        const double heightFrom = glm::dot(normal, from), heightTo = glm::dot(normal, to);
        if (heightFrom >= 0.0) clipped.push_back(from);
        if ((heightFrom < 0.0) != (heightTo < 0.0))
            clipped.push_back(from + (to - from) * (heightFrom / (heightFrom - heightTo)));
    }
    return clipped;
}

} // namespace

double rectangleFormFactor(const dvec3& point, const dvec3& normal, const RectangleCorners& corners) {
    const dvec3 plane = glm::cross(corners[1] - corners[0], corners[3] - corners[0]);
    if (glm::dot(plane, corners[0] - point) == 0.0) return 0.0; // seen edge-on; the sum has no limit at a corner
    std::vector<dvec3> polygon;
    for (const dvec3& corner : corners)
        polygon.push_back(corner - point);
    polygon = clipToHorizon(polygon, normal);
    double sum = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const dvec3 cross = glm::cross(a, b);
        const double length = glm::length(cross);
        // An edge that points at the element spans no angle.
        if (length > 0.0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(normal, cross) / length;
    }
    return std::abs(sum) / (2.0 * std::numbers::pi);
}

} // namespace q3rt
