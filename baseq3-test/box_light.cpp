// Direct light in a box map, in double precision.

#include <algorithm>
#include <limits>

#include "baseq3-test/box_map.hpp"

namespace q3rt {

namespace {

constexpr int kLightParts = 8; ///< a side

/// Does the straight way from `from`, in air box `airBox`, to `to` stay in air? A line meets a convex box once at most.
bool isOpen(const BoxMap& map, const std::vector<BoxPortal>& portals, size_t airBox, const dvec3& from,
            const dvec3& to) {
    const dvec3 way = to - from;
    std::vector<bool> visited(map.air.size());
    for (;;) {
        visited[airBox] = true;
        const IntBox& box = map.air[airBox].box;
        double exit = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis)
            if (way[axis] != 0.0)
                exit = std::min(exit, ((way[axis] > 0.0 ? box.maxs : box.mins)[axis] - from[axis]) / way[axis]);
        if (exit >= 1.0) return true;
        const dvec3 at = from + way * exit;
        const auto next = std::find_if(portals.begin(), portals.end(), [&](const BoxPortal& portal) {
            if (portal.from != airBox || visited[portal.to]) return false;
            for (int axis = 0; axis < 3; ++axis) {
                // The flat axis is met by construction, give or take rounding.
                const bool flat = portal.rectangle.mins[axis] == portal.rectangle.maxs[axis];
                if (flat ? std::abs(at[axis] - portal.rectangle.mins[axis]) > 1e-6
                         : at[axis] < portal.rectangle.mins[axis] || at[axis] > portal.rectangle.maxs[axis])
                    return false;
            }
            return true;
        });
        if (next == portals.end()) return false;
        airBox = next->to;
    }
}

} // namespace

dvec3 computeIrradiance(const BoxMap& map, const std::vector<BoxPortal>& portals, const std::vector<BoxFace>& faces,
                        size_t airBox, const dvec3& point, const dvec3& normal) {
    dvec3 sum(0.0);
    for (const BoxFace& face : faces) {
        if (face.panel < 0 || map.panels[static_cast<size_t>(face.panel)].surfaceLight <= 0.0f) continue;
        const WallPanel& panel = map.panels[static_cast<size_t>(face.panel)];
        // Only the side that faces the air shines; a point in the light's own plane gets nothing.
        if ((point[face.axis] - face.rectangle.mins[face.axis]) * face.towards <= 0.0) continue;
        const RectangleCorners all = computeCorners(face.rectangle, face.axis, face.towards);
        const dvec3 stepU = (all[1] - all[0]) / double(kLightParts), stepV = (all[3] - all[0]) / double(kLightParts);
        double formFactor = 0;
        for (int i = 0; i < kLightParts; ++i)
            for (int j = 0; j < kLightParts; ++j) {
                const dvec3 corner = all[0] + stepU * double(i) + stepV * double(j);
                if (isOpen(map, portals, airBox, point, corner + 0.5 * (stepU + stepV)))
                    formFactor += rectangleFormFactor(point, normal,
                                                      {corner, corner + stepU, corner + stepU + stepV, corner + stepV});
            }
        sum += 0.75 * double(panel.surfaceLight) * formFactor * dvec3(panel.lightColor);
    }
    return sum;
}

} // namespace q3rt
