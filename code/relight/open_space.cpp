#include "relight/open_space.hpp"

#include <algorithm>

#include "relight/sampling.hpp"

namespace q3rt {
namespace {

/// Steps of the walk for each point wanted.
constexpr size_t kStepsPerPoint = 12;
constexpr size_t kNearestPoints = 48, kWitnesses = 12;
constexpr float kFirstCellQu = 32;

/// Cells of the grid that finds near points: a room's size.
constexpr float kNearCellQu = 192;
constexpr int kMostRings = 6;

/// The first point of each cell.
std::vector<vec3> thin(const std::vector<vec3>& points, float cellQu) {
    PointGrid taken(cellQu);
    std::vector<vec3> kept;
    for (const vec3& point : points)
        if (taken.near(point, 0).empty()) {
            taken.add(point);
            kept.push_back(point);
        }
    return kept;
}

} // namespace

OpenSpace::OpenSpace(const World& world, const LightOccluders& occluders, size_t count)
    : m_occluders(occluders)
    , m_grid(kNearCellQu) {
    PointGrid taken(kFirstCellQu);
    const auto add = [&](const vec3& point) {
        if (world.clusterOf(point) < 0 || !taken.near(point, 0).empty()) return;
        taken.add(point);
        m_grid.add(point);
        m_points.push_back(point);
    };
    for (const MapEntity& entity : world.entities)
        if (const auto origin = entity.vector("origin"); origin && !entity.className().starts_with("light"))
            add(*origin);
    if (m_points.empty()) return;
    // A walk in straight lines from points that are known to be open. Later points are tried as often as early ones, so
    // that the walk spreads.
    for (uint32_t step = 0; step < count * kStepsPerPoint; ++step) {
        const vec3 from = m_points[step % m_points.size()];
        const vec3 direction = sphereDirection(planePoint(step, 0));
        OccluderHit hit;
        if (!occluders.closest(from, direction, occluders.farQu(), hit)) continue;
        const vec3 point = from + (0.1f + 0.85f * unitOf(hashOf(step))) * hit.t * direction;
        if (seenByAnother(point, from)) add(point);
    }
    const std::vector<vec3> all = m_points;
    for (float cell = kFirstCellQu; m_points.size() > count; cell *= 1.1f)
        m_points = thin(all, cell);
    m_grid = PointGrid(kNearCellQu);
    for (const vec3& point : m_points)
        m_grid.add(point);
}

std::vector<uint32_t> OpenSpace::nearest(const vec3& place, size_t count) const {
    std::vector<uint32_t> found;
    for (int rings = 1; rings <= kMostRings && found.size() < count; ++rings)
        found = m_grid.near(place, rings);
    const auto distance = [&](uint32_t i) { return glm::dot(m_points[i] - place, m_points[i] - place); };
    const size_t kept = std::min(count, found.size());
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end(),
                      [&](uint32_t a, uint32_t b) { return std::pair(distance(a), a) < std::pair(distance(b), b); });
    found.resize(kept);
    return found;
}

/// A second sight: what one line reaches through a seam, no other does.
bool OpenSpace::seenByAnother(const vec3& point, const vec3& from) const {
    const std::vector<uint32_t> witnesses = nearest(from, kWitnesses);
    return witnesses.size() < kWitnesses || std::any_of(witnesses.begin(), witnesses.end(), [&](uint32_t i) {
               return m_points[i] != from && !m_occluders.occluded(m_points[i], point - m_points[i], 1);
           });
}

bool OpenSpace::sees(const vec3& position, const vec3& normal) const {
    const std::vector<uint32_t> near = nearest(position, kNearestPoints);
    return std::any_of(near.begin(), near.end(), [&](uint32_t i) {
        const vec3 to = m_points[i] - position;
        return glm::dot(to, normal) > 0 && !m_occluders.occluded(position, to, 1);
    });
}

} // namespace q3rt
