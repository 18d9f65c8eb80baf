// Walls, panels and openings of a box map.

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "baseq3-test/box_map.hpp"

namespace q3rt {

namespace {

/// The rectangle that two boxes share, flat in one axis, or nothing.
bool findSharedSide(const IntBox& a, const IntBox& b, IntBox& shared) {
    shared = {glm::max(a.mins, b.mins), glm::min(a.maxs, b.maxs)};
    const ivec3 size = shared.maxs - shared.mins;
    return glm::all(glm::greaterThanEqual(size, ivec3(0))) && (size.x == 0) + (size.y == 0) + (size.z == 0) == 1;
}

void requireDisjoint(const BoxMap& map) {
    for (size_t i = 0; i < map.air.size(); ++i)
        for (size_t j = 0; j < i; ++j) {
            const ivec3 overlap =
                glm::min(map.air[i].box.maxs, map.air[j].box.maxs) - glm::max(map.air[i].box.mins, map.air[j].box.mins);
            if (glm::all(glm::greaterThan(overlap, ivec3(0))))
                throw UsageError(formatText("air boxes %zu and %zu overlap", j, i));
        }
}

/// Splits a side along every edge of what lies in it, so that neighbours share whole edges.
std::vector<IntBox> splitSide(const IntBox& side, int axis, const std::vector<IntBox>& inside) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::set<int> cuts[2] = {{side.mins[u], side.maxs[u]}, {side.mins[v], side.maxs[v]}};
    for (const IntBox& rectangle : inside) {
        cuts[0].insert({rectangle.mins[u], rectangle.maxs[u]});
        cuts[1].insert({rectangle.mins[v], rectangle.maxs[v]});
    }
    std::vector<IntBox> parts;
    for (auto a = cuts[0].begin(); std::next(a) != cuts[0].end(); ++a)
        for (auto b = cuts[1].begin(); std::next(b) != cuts[1].end(); ++b) {
            IntBox part = side;
            part.mins[u] = *a, part.maxs[u] = *std::next(a);
            part.mins[v] = *b, part.maxs[v] = *std::next(b);
            parts.push_back(part);
        }
    return parts;
}

void addSide(const BoxMap& map, const std::vector<BoxPortal>& portals, size_t airBox, int axis, bool upper,
             std::vector<BoxFace>& faces) {
    const IntBox& box = map.air[airBox].box;
    IntBox side = box;
    (upper ? side.mins : side.maxs)[axis] = upper ? box.maxs[axis] : box.mins[axis];
    std::vector<IntBox> openings, inside;
    for (const BoxPortal& portal : portals)
        if (portal.from == airBox && side.contains(portal.rectangle)) openings.push_back(portal.rectangle);
    inside = openings;
    for (const WallPanel& panel : map.panels)
        if (side.contains(panel.rectangle)) inside.push_back(panel.rectangle);
    for (const IntBox& part : splitSide(side, axis, inside)) {
        if (std::any_of(openings.begin(), openings.end(), [&](const IntBox& o) { return o.contains(part); })) continue;
        BoxFace face{airBox, axis, upper ? -1 : 1, part, -1};
        for (size_t panel = 0; panel < map.panels.size(); ++panel)
            if (map.panels[panel].rectangle.contains(part)) face.panel = static_cast<int>(panel);
        faces.push_back(face);
    }
}

} // namespace

RectangleCorners computeCorners(const IntBox& rectangle, int axis, int towards) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    RectangleCorners corners;
    for (size_t i = 0; i < 4; ++i) {
        // Around u, v: counter-clockwise as seen from the positive axis.
        const size_t at = towards > 0 ? 3 - i : i;
        corners[i] = dvec3(rectangle.mins);
        if (at == 1 || at == 2) corners[i][u] = rectangle.maxs[u];
        if (at == 2 || at == 3) corners[i][v] = rectangle.maxs[v];
    }
    return corners;
}

std::vector<BoxPortal> findPortals(const BoxMap& map) {
    std::vector<BoxPortal> portals;
    IntBox shared;
    for (size_t from = 0; from < map.air.size(); ++from)
        for (size_t to = 0; to < map.air.size(); ++to)
            if (from != to && findSharedSide(map.air[from].box, map.air[to].box, shared))
                portals.push_back({from, to, shared});
    return portals;
}

std::vector<BoxFace> buildFaces(const BoxMap& map, const std::vector<BoxPortal>& portals) {
    requireDisjoint(map);
    std::vector<BoxFace> faces;
    for (size_t airBox = 0; airBox < map.air.size(); ++airBox)
        for (int axis = 0; axis < 3; ++axis)
            for (const bool upper : {false, true})
                addSide(map, portals, airBox, axis, upper, faces);
    for (size_t panel = 0; panel < map.panels.size(); ++panel)
        if (std::none_of(faces.begin(), faces.end(),
                         [&](const BoxFace& face) { return face.panel == static_cast<int>(panel); }))
            throw UsageError(formatText("panel %zu lies in no wall", panel));
    return faces;
}

} // namespace q3rt
