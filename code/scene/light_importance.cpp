// How much of each light a row's points are likely to see: guides the choice of lights, decides nothing.

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/light_rows_build.hpp"

namespace q3rt {
namespace {

using glm::unpackUnorm2x16;
#include "shaders/lib/light_row.glsl"

/// Points that stand for a row; more of them change little.
constexpr size_t kPointsOfRow = 8, kPointsOfWorld = 64;
/// Shares of the choice that go by the bound, which limits how wrong a weight can be where no point stands, and to all
/// lights alike, so that the faintest one is still drawn by a number of 32 bits.
constexpr double kBoundShare = 0.125, kEqualShare = 0.015625;

/// Weighted reservoir: the k points of largest u^(1 / area) (Efraimidis and Spirakis 2006).
class PointPicker {
  public:
    void offer(const RowPoint& point, double area, double uniform, size_t limit) {
        m_kept.push_back({std::log(uniform) / area, point});
        std::push_heap(m_kept.begin(), m_kept.end(), isWorse);
        if (m_kept.size() <= limit) return;
        std::pop_heap(m_kept.begin(), m_kept.end(), isWorse);
        m_kept.pop_back();
    }
    std::vector<RowPoint> points() const {
        std::vector<RowPoint> result;
        for (const Kept& kept : m_kept)
            result.push_back(kept.point);
        return result;
    }

  private:
    struct Kept {
        double key;
        RowPoint point;
    };
    static bool isWorse(const Kept& a, const Kept& b) { return a.key > b.key; } // the heap's front is the worst
    std::vector<Kept> m_kept;
};

struct ClusterPickers {
    std::array<PointPicker, kNormalClassCount> pickers;
};

class SurfaceSampler {
  public:
    SurfaceSampler(const World& world, size_t clusterCount)
        : m_world(world)
        , m_points(clusterCount + 1)
        , m_pickers(clusterCount + 1) {}

    void addTriangle(const vec3 (&corner)[3]) {
        const vec3 facing = glm::cross(corner[2] - corner[0], corner[1] - corner[0]);
        if (!(glm::dot(facing, facing) > 0.0f)) return;
        const uint front = normalClass(facing);
        const vec3 normal = glm::normalize(facing);
        visitLeafs(m_world.bsp, {corner, corner + 3}, 0.0f, [&](const BspLeaf& leaf, const Polygon& part) {
            if (leaf.cluster >= 0 && leaf.cluster < m_world.bsp.clusterCount)
                addPart(static_cast<size_t>(leaf.cluster), part, normal, front);
        });
        addPart(m_points.size() - 1, {corner, corner + 3}, normal, 0);
    }

    std::vector<ClusterPoints> finish() {
        for (size_t c = 0; c < m_points.size(); ++c)
            for (size_t k = 0; k < kNormalClassCount; ++k)
                m_points[c][k].points = m_pickers[c].pickers[k].points();
        return std::move(m_points);
    }

  private:
    void addPart(size_t cluster, const Polygon& part, const vec3& normal, uint front) {
        const size_t limit = cluster + 1 == m_points.size() ? kPointsOfWorld : kPointsOfRow;
        for (size_t i = 2; i < part.size(); ++i) {
            const vec3 edge1 = part[i - 1] - part[0], edge2 = part[i] - part[0];
            const double area = 0.5 * static_cast<double>(glm::length(glm::cross(edge1, edge2)));
            if (!(area > 0)) continue;
            const float root = std::sqrt(number()), v = number();
            const vec3 point = part[0] + edge1 * (root * (1.0f - v)) + edge2 * (root * v);
            m_pickers[cluster].pickers[0].offer({point, normal}, area, m_uniform(m_random), limit);
            m_points[cluster][0].area += area;
            // A surface may be seen, and lit, from both sides.
            for (const uint side : {front, front == 0 ? 0 : ((front - 1) ^ 1u) + 1}) {
                if (side == 0) continue;
                RowPoints& of = m_points[cluster][side];
                m_pickers[cluster].pickers[side].offer({point, side == front ? normal : -normal}, area,
                                                       m_uniform(m_random), limit);
                of.area += area;
                for (const vec3& corner : part)
                    of.plane = std::min(of.plane, alongClass(side, corner));
            }
        }
    }
    float number() { return std::uniform_real_distribution<float>(0, 1)(m_random); }

    const World& m_world;
    std::vector<ClusterPoints> m_points;
    std::vector<ClusterPickers> m_pickers;
    std::mt19937 m_random{1};
    std::uniform_real_distribution<double> m_uniform{1e-9, 1.0};
};

/// Farthest distance of the box from a plane, on the side of its normal; infinite boxes give infinity.
float farthestAlong(const Bounds& box, const vec3& normal) {
    float sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (normal[axis] > 0.0f) sum += normal[axis] * box.maxs[axis];
        if (normal[axis] < 0.0f) sum += normal[axis] * box.mins[axis];
    }
    return sum;
}

/// Largest cosine toward any point of a sphere of this radius, from the cosine x distance of its centre; 0 where the
/// sphere is wholly behind.
float looseCosine(float along, float distance, float radiusQu) {
    return std::max(0.0f, std::min(1.0f, (along + radiusQu) / (distance + radiusQu)));
}

/// Irradiance at a point without shadow, about right.
float estimate(const RowLight& light, const vec3& point, uint32_t normalClass) {
    const vec3 way = light.center() - point;
    const float distance = glm::length(way);
    if (distance > light.farthestQu) return 0;
    const float nearest = std::max({light.radiusQu, light.nearestQu, distance});
    float given = light.strength / (nearest * nearest);
    if (light.normal != vec3(0.0f)) given *= looseCosine(-glm::dot(light.normal, way), distance, light.radiusQu);
    if (normalClass != 0) given *= looseCosine(alongClass(normalClass, way), distance, light.radiusQu);
    return given;
}

/// The most that a point of the box may get, about.
float bound(const RowLight& light, const Bounds& box) {
    const vec3 center = light.center();
    const float distance = glm::distance(center, glm::clamp(center, box.mins, box.maxs));
    const float nearest = std::max({light.radiusQu, light.nearestQu, distance - light.radiusQu});
    return light.strength / (nearest * nearest);
}

void addNormalised(std::vector<double>& sum, const std::vector<double>& weights, double share) {
    double total = 0;
    for (const double weight : weights)
        total += weight;
    if (!(total > 0)) return;
    for (size_t i = 0; i < sum.size(); ++i)
        sum[i] += share * weights[i] / total;
}

} // namespace

std::vector<ClusterPoints> pickClusterPoints(const World& world, const MaterialLibrary& materials) {
    SurfaceSampler sampler(world, static_cast<size_t>(world.bsp.clusterCount));
    for (const WorldSurface& surface : world.surfaces) {
        if (!surface.drawn || surface.bspModel != 0 || materials.get(surface.material).isSky) continue;
        for (uint32_t i = 0; i + 2 < surface.indexCount; i += 3) {
            const auto corner = [&](uint32_t k) {
                return world.vertices[world.indices[surface.firstIndex + i + k]].position;
            };
            sampler.addTriangle({corner(0), corner(1), corner(2)});
        }
    }
    return sampler.finish();
}

bool shinesToward(const RowLight& light, const RowRegion& region) {
    if (std::isinf(light.reachQu)) return true;
    if (light.normal != vec3(0.0f) && light.reachQu == 0.0f) {
        // A point this near to the light's plane, by rounding, takes nothing from it anyway (rt/lights.glsl).
        if (farthestAlong(region.box, light.normal) <= glm::dot(light.normal, light.corner[0])) return false;
    }
    const vec3 center = light.center();
    if (glm::distance(center, glm::clamp(center, region.box.mins, region.box.maxs)) > light.farthestQu) return false;
    if (region.normalClass == 0) return true;
    float along = -std::numeric_limits<float>::infinity();
    for (const vec3& corner : light.corner)
        along = std::max(along, alongClass(region.normalClass, corner));
    return along + light.reachQu > region.points->plane;
}

std::vector<double> weighLights(std::span<const RowLight> lights, std::span<const uint32_t> list,
                                const RowRegion& region) {
    std::vector<double> means(list.size(), 0.0), bounds(list.size(), 0.0), weights(list.size(), 0.0);
    for (size_t i = 0; i < list.size(); ++i) {
        const RowLight& light = lights[list[i]];
        bounds[i] = static_cast<double>(bound(light, region.box));
        for (const RowPoint& point : region.points->points)
            means[i] += static_cast<double>(estimate(light, point.position, region.normalClass));
    }
    addNormalised(weights, means, 1 - kBoundShare);
    addNormalised(weights, bounds, kBoundShare);
    addNormalised(weights, std::vector<double>(list.size(), 1.0), kEqualShare);
    return weights;
}

} // namespace q3rt
