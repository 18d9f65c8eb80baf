// Which clusters of a box map can see each other.

#include <algorithm>
#include <functional>

#include "baseq3-test/box_map.hpp"

namespace q3rt {

namespace {

struct Point2 {
    int64_t x = 0, y = 0;
};

/// Is there a line that meets every rectangle, in the projection along `axis`? If one exists, another goes through two
/// corners, so those are all candidates. Integers throughout: exact.
bool existsStabbingLine(const std::vector<IntBox>& rectangles, int axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto cornersOf = [&](const IntBox& r) {
        return std::array<Point2, 4>{
            Point2{r.mins[u], r.mins[v]}, {r.maxs[u], r.mins[v]}, {r.maxs[u], r.maxs[v]}, {r.mins[u], r.maxs[v]}};
    };
    std::vector<Point2> corners;
    for (const IntBox& rectangle : rectangles)
        for (const Point2& corner : cornersOf(rectangle))
            corners.push_back(corner);
    const auto meetsAll = [&](const Point2& a, const Point2& b) {
        return std::all_of(rectangles.begin(), rectangles.end(), [&](const IntBox& rectangle) {
            int64_t least = INT64_MAX, most = INT64_MIN;
            for (const Point2& p : cornersOf(rectangle)) {
                const int64_t side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
                least = std::min(least, side);
                most = std::max(most, side);
            }
            return least <= 0 && most >= 0;
        });
    };
    for (const Point2& a : corners)
        for (const Point2& b : corners)
            if ((a.x != b.x || a.y != b.y) && meetsAll(a, b)) return true;
    return false;
}

bool canSeeThrough(const std::vector<IntBox>& openings) {
    return existsStabbingLine(openings, 0) && existsStabbingLine(openings, 1) && existsStabbingLine(openings, 2);
}

} // namespace

BoxVisibility computeVisibility(const BoxMap& map, const std::vector<BoxPortal>& portals) {
    BoxVisibility visibility;
    for (const AirBox& air : map.air)
        visibility.clusterCount = std::max(visibility.clusterCount, air.cluster + 1);
    visibility.rowBytes = (visibility.clusterCount + 63) / 64 * 8; // rows of whole 64-bit words, as map compilers write
    visibility.rows.resize(static_cast<size_t>(visibility.clusterCount * visibility.rowBytes));
    const auto mark = [&](int from, int to) {
        visibility.rows[static_cast<size_t>(from * visibility.rowBytes + to / 8)] |= static_cast<uint8_t>(1 << to % 8);
    };
    for (size_t start = 0; start < map.air.size(); ++start) {
        std::vector<IntBox> openings;
        std::vector<bool> onWay(map.air.size());
        const std::function<void(size_t)> visit = [&](size_t airBox) {
            onWay[airBox] = true;
            mark(map.air[start].cluster, map.air[airBox].cluster);
            for (const BoxPortal& portal : portals) {
                if (portal.from != airBox || onWay[portal.to]) continue;
                openings.push_back(portal.rectangle);
                if (canSeeThrough(openings)) visit(portal.to);
                openings.pop_back();
            }
            onWay[airBox] = false;
        };
        visit(start);
    }
    return visibility;
}

} // namespace q3rt
