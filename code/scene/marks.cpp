// MarkFragments: decals clipped against the world (spec of world 8.2). Limits, ranges and tolerances are those that the
// game code's marks were made for.

#include <algorithm>
#include <cstddef>

#include "scene/busy_frame.hpp"
#include "scene/world.hpp"
#include "scene/world_math.hpp"

namespace q3rt {
namespace {

constexpr size_t kMaxSurfaces = 64;              // examined per mark
constexpr size_t kMaxPolygonPoints = 64;         // of the mark; more are ignored
constexpr float kSearchBackQu = 20.0f;           // the search box reaches this far against the projection
constexpr float kNearQu = 32.0f, kFarQu = 20.0f; // depth range about the first point
constexpr float kOnPlaneQu = 0.5f;               // nearer than this to a clip plane counts as on it
constexpr float kPlanarFacing = -0.5f;           // largest dot(normal, projection) that takes a mark
constexpr float kPatchFacingFirst = -0.1f, kPatchFacingSecond = -0.05f;

enum BoxSide { kFront = 1, kBack = 2, kBoth = 3 };

BoxSide classifyBox(const Bounds& box, const Plane& plane) {
    for (int i = 0; i < 3; ++i) {
        if (plane.normal[i] != 1.0f) continue;
        if (plane.distance <= box.mins[i]) return kFront;
        return plane.distance >= box.maxs[i] ? kBack : kBoth;
    }
    vec3 farCorner, nearCorner;
    for (int i = 0; i < 3; ++i) {
        const bool negative = plane.normal[i] < 0.0f;
        farCorner[i] = negative ? box.mins[i] : box.maxs[i];
        nearCorner[i] = negative ? box.maxs[i] : box.mins[i];
    }
    int side = 0;
    if (glm::dot(plane.normal, farCorner) >= plane.distance) side |= kFront;
    if (glm::dot(plane.normal, nearCorner) < plane.distance) side |= kBack;
    return static_cast<BoxSide>(side);
}

} // namespace

/// The convex volume of a mark: what is inside is in front of every plane.
struct MarkClipper::Volume {
    Bounds box;
    vec3 direction{0}; ///< of projection, unit
    std::vector<Plane>& planes;
};

MarkClipper::Volume MarkClipper::makeVolume(const std::vector<vec3>& polygon, const vec3& projection) {
    m_planes.clear();
    Volume volume{.planes = m_planes};
    const size_t count = std::min(polygon.size(), kMaxPolygonPoints);
    volume.direction = normalizeOrZero(projection);
    for (size_t i = 0; i < count; ++i) {
        volume.box.add(polygon[i]);
        volume.box.add(polygon[i] + projection);
        volume.box.add(polygon[i] - volume.direction * kSearchBackQu);
        const vec3 edge = polygon[(i + 1) % count] - polygon[i];
        const vec3 normal = fastNormalize(glm::cross(edge, -projection));
        volume.planes.push_back({normal, glm::dot(normal, polygon[i])});
    }
    const float depth = glm::dot(volume.direction, polygon[0]);
    volume.planes.push_back({volume.direction, depth - kNearQu});
    volume.planes.push_back({-volume.direction, -depth - kFarQu});
    return volume;
}

namespace {

bool takesMarks(const MaterialLibrary& materials, const Bounds& box, const vec3& direction,
                const WorldSurface& surface) {
    if (!surface.drawn) return false;
    const Material& material = materials.get(surface.material);
    if (material.surfaceFlags & (surfaceParm::kNoImpact | surfaceParm::kNoMarks)) return false;
    if (material.contentFlags & surfaceParm::kContentsFog) return false;
    if (surface.type != BspSurfaceType::Planar) return surface.type != BspSurfaceType::Flare;
    return classifyBox(box, surface.plane) == kBoth && glm::dot(surface.plane.normal, direction) <= kPlanarFacing;
}

} // namespace

/// Surfaces of all leafs that the box touches, in leaf order, each once.
void MarkClipper::findSurfaces(const World& world, const MaterialLibrary& materials, const Volume& volume) {
    std::vector<int>&found = m_surfaces, &open = m_openNodes;
    found.clear();
    open.assign({world.bsp.nodes.empty() ? -1 : 0});
    while (!open.empty()) {
        const int child = open.back();
        open.pop_back();
        if (child >= 0) {
            const BspNode& node = world.bsp.nodes[static_cast<size_t>(child)];
            const BoxSide side = classifyBox(volume.box, world.bsp.planes[static_cast<size_t>(node.plane)]);
            if (side & kBack) open.push_back(node.children[1]);
            if (side & kFront) open.push_back(node.children[0]);
            continue;
        }
        const BspLeaf& leaf = world.bsp.leafs[static_cast<size_t>(-1 - child)];
        for (int i = 0; i < leaf.leafSurfaceCount && found.size() < kMaxSurfaces; ++i) {
            const int number = world.bsp.leafSurfaces[static_cast<size_t>(leaf.firstLeafSurface + i)];
            if (!takesMarks(materials, volume.box, volume.direction, world.surfaces[static_cast<size_t>(number)]))
                continue;
            if (std::find(found.begin(), found.end(), number) == found.end()) found.push_back(number);
        }
    }
}

namespace {

/// Keeps what lies in front of the plane. A polygon that is nowhere clearly in front vanishes.
void clipPolygon(std::vector<vec3>& polygon, const Plane& plane, std::vector<vec3>& scratch) {
    enum Side { front, back, on };
    const auto distanceOf = [&](const vec3& p) { return glm::dot(p, plane.normal) - plane.distance; };
    const auto sideOf = [](float d) { return d > kOnPlaneQu ? front : d < -kOnPlaneQu ? back : on; };
    bool anyFront = false, anyBack = false;
    for (const vec3& point : polygon) {
        const Side side = sideOf(distanceOf(point));
        anyFront = anyFront || side == front;
        anyBack = anyBack || side == back;
    }
    if (!anyFront) polygon.clear();
    if (!anyFront || !anyBack) return;
    scratch.clear();
    for (size_t i = 0; i < polygon.size(); ++i) {
        const vec3& a = polygon[i];
        const vec3& b = polygon[(i + 1) % polygon.size()];
        const float da = distanceOf(a), db = distanceOf(b);
        const Side sideA = sideOf(da), sideB = sideOf(db);
        if (sideA != back) scratch.push_back(a);
        if (sideA == on || sideB == on || sideA == sideB) continue;
        scratch.push_back(a + (b - a) * (da / (da - db))); // opposite sides: da - db is at least 2 kOnPlaneQu
    }
    polygon.swap(scratch);
}

/// Does the box lie behind one of the planes? Nothing of it is then left: that takes a point kOnPlaneQu before each,
/// and rounding is far less.
bool liesBehind(const Bounds& box, std::span<const Plane> planes) {
    if (box.empty()) return false;
    const vec3 centre = (box.mins + box.maxs) * 0.5f, half = (box.maxs - box.mins) * 0.5f;
    return std::ranges::any_of(planes, [&](const Plane& plane) {
        return glm::dot(plane.normal, centre) + glm::dot(glm::abs(plane.normal), half) < plane.distance;
    });
}

} // namespace

/// The caller's buffers and their limits.
struct MarkClipper::Output {
    size_t maxPoints, maxFragments;
    std::vector<vec3>& points;
    std::vector<MarkFragment>& fragments;
    size_t firstPoint, firstFragment;

    bool full() const { return fragments.size() - firstFragment >= maxFragments; }
    void add(const std::vector<vec3>& polygon) {
        if (points.size() - firstPoint + polygon.size() > maxPoints) return; // this fragment alone is left out
        fragments.push_back({static_cast<int>(points.size() - firstPoint), static_cast<int>(polygon.size())});
        points.insert(points.end(), polygon.begin(), polygon.end());
    }
};

void MarkClipper::clipTriangle(const Volume& volume, const vec3* corners, Output& out) {
    m_polygon.assign(corners, corners + 3);
    for (const Plane& plane : volume.planes) {
        clipPolygon(m_polygon, plane, m_scratch);
        if (m_polygon.empty()) return;
    }
    out.add(m_polygon);
}

void MarkClipper::clipSurface(const World& world, const Volume& volume, const WorldSurface& surface, Output& out) {
    if (liesBehind(surface.bounds, volume.planes)) return;
    for (uint32_t i = 0; i + 2 < surface.indexCount && !out.full(); i += 3) {
        vec3 corners[3];
        for (uint32_t k = 0; k < 3; ++k) {
            corners[k] = world.vertices[world.indices[surface.firstIndex + i + k]].position;
        }
        if (surface.type == BspSurfaceType::Patch) {
            const vec3 normal = fastNormalize(clockwiseCross(corners[0], corners[1], corners[2]));
            const float limit = i % 6 == 0 ? kPatchFacingFirst : kPatchFacingSecond;
            if (glm::dot(normal, volume.direction) >= limit) continue;
        }
        clipTriangle(volume, corners, out);
    }
}

MarkClipper::MarkClipper() {
    m_planes.reserve(busyFrame::kSmall);
    m_surfaces.reserve(kMaxSurfaces);
    m_openNodes.reserve(busyFrame::kSmall);
    m_polygon.reserve(busyFrame::kSmall);
    m_scratch.reserve(busyFrame::kSmall);
}

int MarkClipper::clip(const World& world, const MaterialLibrary& materials, const std::vector<vec3>& polygon,
                      const vec3& projection, size_t maxPoints, std::vector<vec3>& points, size_t maxFragments,
                      std::vector<MarkFragment>& fragments, bool onTriangleSoups) {
    if (polygon.empty()) return 0;
    const Volume volume = makeVolume(polygon, projection);
    Output out{maxPoints, maxFragments, points, fragments, points.size(), fragments.size()};
    findSurfaces(world, materials, volume);
    for (const int number : m_surfaces) {
        const WorldSurface& surface = world.surfaces[static_cast<size_t>(number)];
        if (surface.type == BspSurfaceType::TriangleSoup && !onTriangleSoups) continue;
        if (out.full()) break;
        clipSurface(world, volume, surface, out);
    }
    return static_cast<int>(fragments.size() - out.firstFragment);
}

} // namespace q3rt
