// Which lights can matter in which cluster: the map's own visibility applied to lights.

#include <algorithm>
#include <bit>
#include <cmath>
#include <thread>

#include "scene/alias_table.hpp"
#include "scene/light_rows_build.hpp"
#include "shaders/shared/constants.h"

namespace q3rt {
namespace {

using glm::unpackUnorm2x16;
#include "shaders/lib/light_row.glsl"

/// A light this near to a dividing plane counts as on both sides: map compilers move vertices by up to this much.
constexpr float kPlaneSlackQu = 0.125f;
constexpr float kNeverReached = std::numeric_limits<float>::max();
/// Of a distance beyond which a light gives nothing: far above its own rounding and that of what the shader compares.
constexpr float kFarSlack = 1.0001f;

float sumOf(const vec3& v) { return v.x + v.y + v.z; }

/// A set of light numbers.
class LightBits {
  public:
    explicit LightBits(size_t count)
        : m_words((count + 63) / 64, 0) {}
    void insert(size_t light) { m_words[light / 64] |= uint64_t{1} << (light % 64); }
    void insert(const LightBits& other) {
        for (size_t i = 0; i < m_words.size(); ++i)
            m_words[i] |= other.m_words[i];
    }
    bool holds(size_t light) const { return (m_words[light / 64] >> (light % 64) & 1) != 0; }
    std::vector<uint32_t> list() const {
        std::vector<uint32_t> list;
        for (size_t i = 0; i < m_words.size(); ++i)
            for (uint64_t word = m_words[i]; word != 0; word &= word - 1)
                list.push_back(static_cast<uint32_t>(i * 64 + static_cast<size_t>(std::countr_zero(word))));
        return list;
    }

  private:
    std::vector<uint64_t> m_words;
};

/// The rows of one cluster, numbered from the start of their own entries.
struct ClusterRows {
    std::array<RtLightRow, kNormalClassCount> rows{};
    std::vector<RtLightEntry> entries;
};

/// Sets odds, columns and weights of a row's facing entries for choosing them in proportion to `weights`, one each.
/// `seen` likewise: seenOf().
void setOdds(std::span<RtLightEntry> entries, const std::vector<double>& weights, std::span<const float> seen) {
    std::vector<AliasColumn> columns = buildAliasTable(weights);
    for (size_t i = 0; i < entries.size(); ++i) {
        // Rounded to none, a light that no other column has could not be chosen.
        entries[i].odds = glm::packUnorm2x16(vec2(std::max(columns[i].chance, 1.0f / 65535), seen[i]));
        entries[i].other = columns[i].other;
        columns[i].chance = chanceOf(entries[i]);
    }
    const std::vector<double> probability = aliasProbabilities(columns);
    for (size_t i = 0; i < entries.size(); ++i)
        entries[i].weight = static_cast<float>(1 / probability[i]);
}

class RowBuilder {
  public:
    RowBuilder(const World& world, const MaterialLibrary& materials, std::span<const RowLight> lights)
        : m_bsp(world.bsp)
        , m_lights(lights)
        , m_boxes(boundClusters(world.bsp))
        , m_points(pickClusterPoints(world, materials))
        , m_everywhere(lights.size())
        , m_all(lights.size())
        , m_touching(clusterCount(), LightBits(lights.size()))
        , m_holdsLight(clusterCount(), 0) {
        for (size_t i = 0; i < lights.size(); ++i)
            if (lights[i].strength > 0.0f) place(i);
    }

    size_t clusterCount() const { return static_cast<size_t>(m_bsp.clusterCount); }

    ClusterRows buildCluster(size_t cluster) const {
        ClusterRows out;
        // Seen one way or the other: what the map's visibility does not rule out. Nothing can be seen only one way:
        // what rules it out in either direction is right.
        LightBits eitherWay = m_everywhere, bothWays = m_everywhere;
        for (size_t other = 0; other < clusterCount(); ++other) {
            if (!m_holdsLight[other]) continue;
            const bool there = m_bsp.clusterVisible(static_cast<int>(cluster), static_cast<int>(other));
            const bool back = m_bsp.clusterVisible(static_cast<int>(other), static_cast<int>(cluster));
            if (there || back) eitherWay.insert(m_touching[other]);
            if (there && back) bothWays.insert(m_touching[other]);
        }
        const std::vector<uint32_t> candidates = eitherWay.list();
        for (uint32_t k = 0; k < kNormalClassCount; ++k) {
            const RowPoints& points = m_points[cluster][k];
            out.rows[k].plane = kNeverReached;
            if (k > 0 && !(points.area > 0)) continue;
            addRow(out, {m_boxes[cluster], k, &points}, candidates, &bothWays);
        }
        return out;
    }

    std::vector<ClusterPoints> takePoints() { return std::move(m_points); }

    ClusterRows buildOutside() const {
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        ClusterRows out;
        addRow(out, {{vec3(-kInfinity), vec3(kInfinity)}, 0, &m_points.back()[0]}, m_all.list(), nullptr);
        return out;
    }

  private:
    void place(size_t i) {
        m_all.insert(i);
        const RowLight& light = m_lights[i];
        bool touches = false;
        if (!std::isinf(light.reachQu))
            visitLeafs(m_bsp, {light.corner, light.corner + 3}, kPlaneSlackQu + light.reachQu,
                       [&](const BspLeaf& leaf, const Polygon&) {
                           if (leaf.cluster < 0 || leaf.cluster >= m_bsp.clusterCount) return;
                           m_touching[static_cast<size_t>(leaf.cluster)].insert(i);
                           m_holdsLight[static_cast<size_t>(leaf.cluster)] = touches = true;
                       });
        if (!touches) m_everywhere.insert(i);
    }

    /// Facing lights first. `visible`: those of the candidates that count among them.
    void addRow(ClusterRows& out, const RowRegion& region, const std::vector<uint32_t>& candidates,
                const LightBits* visible) const {
        RtLightRow& row = out.rows[region.normalClass];
        std::vector<uint32_t> list, rest;
        for (const uint32_t light : candidates) {
            const bool faces = (!visible || visible->holds(light)) && shinesToward(m_lights[light], region);
            (faces ? list : rest).push_back(light);
        }
        row.first = static_cast<uint>(out.entries.size());
        row.facing = static_cast<uint>(list.size());
        row.plane = region.points->plane;
        for (const uint32_t light : list)
            out.entries.push_back({light, 0, 0, 0});
        if (!list.empty())
            setOdds(std::span(out.entries).last(list.size()), weighLights(m_lights, list, region),
                    std::vector<float>(list.size(), 1.0f));
        // Only the row of all normals is asked for the others.
        if (region.normalClass == 0)
            for (const uint32_t light : rest)
                out.entries.push_back({light, 0, 0, 0});
        row.count = static_cast<uint>(out.entries.size()) - row.first;
    }

    const Bsp& m_bsp;
    std::span<const RowLight> m_lights;
    std::vector<Bounds> m_boxes;
    std::vector<ClusterPoints> m_points;
    LightBits m_everywhere, m_all;
    std::vector<LightBits> m_touching; ///< by cluster
    std::vector<char> m_holdsLight;
};

void append(LightRows& rows, const ClusterRows& cluster, size_t rowCount) {
    for (size_t k = 0; k < rowCount; ++k) {
        RtLightRow row = cluster.rows[k];
        row.first += static_cast<uint>(rows.entries.size());
        rows.rows.push_back(row);
    }
    rows.entries.insert(rows.entries.end(), cluster.entries.begin(), cluster.entries.end());
}

} // namespace

void followSight(LightRows& rows, const RtLightRow& row, std::span<const float> seen) {
    const auto entries = std::span(rows.entries).subspan(row.first, row.facing);
    if (entries.empty()) return;
    std::vector<double> weights;
    for (size_t i = 0; i < entries.size(); ++i)
        weights.push_back(static_cast<double>(seen[i]) / static_cast<double>(entries[i].weight));
    setOdds(entries, weights, seen);
}

DrawnLight drawLight(const LightRows& rows, const RtLightRow& row, uint32_t bits) {
    const uint64_t product = uint64_t{bits} * row.facing;
    const RtLightEntry* entry = &rows.entries[row.first + static_cast<uint32_t>(product >> 32)];
    const auto rest = static_cast<uint32_t>(product);
    if (static_cast<float>(rest >> 8) * 0x1p-24f >= chanceOf(*entry)) entry = &rows.entries[row.first + entry->other];
    return {entry->light, entry->weight};
}

std::vector<RowLight> describeRowLights(std::span<const TriangleLight> triangles, std::span<const PointLight> points) {
    std::vector<RowLight> lights;
    for (const TriangleLight& triangle : triangles) {
        RowLight& light = lights.emplace_back();
        std::copy(triangle.corner, triangle.corner + 3, light.corner);
        if (!triangle.twoSided) light.normal = triangle.normal;
        light.strength = sumOf(triangle.radiance) * triangle.areaQu2;
        light.reachQu = triangle.bspModel != 0 ? std::numeric_limits<float>::infinity() : triangle.reachQu;
        for (const vec3& corner : triangle.corner)
            light.radiusQu = std::max(light.radiusQu, glm::distance(corner, light.center()));
        if (!std::isinf(light.reachQu)) light.radiusQu += light.reachQu;
        if (triangle.faintest > 0) {
            const float strongest = std::max({triangle.radiance.x, triangle.radiance.y, triangle.radiance.z});
            const float farthest = std::max(kFarTriangleSizes, std::sqrt(strongest / triangle.faintest));
            light.farthestQu = kFarSlack * farthest * std::sqrt(triangle.areaQu2) + light.reachQu;
        }
    }
    for (const PointLight& point : points) {
        RowLight& light = lights.emplace_back();
        std::fill(light.corner, light.corner + 3, point.origin);
        light.strength = sumOf(point.intensity);
        light.nearestQu = kLightMinDistanceQu;
        const float strongest = std::max({point.intensity.x, point.intensity.y, point.intensity.z});
        if (point.faintest > 0) light.farthestQu = kFarSlack * std::sqrt(strongest / point.faintest);
    }
    return lights;
}

LightRows buildLightRows(const World& world, const MaterialLibrary& materials, std::span<const RowLight> lights) {
    RowBuilder builder(world, materials, lights);
    std::vector<ClusterRows> clusters(builder.clusterCount());
    const size_t threadCount = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::thread> threads;
    for (size_t t = 0; t < threadCount; ++t)
        threads.emplace_back([&, t] {
            for (size_t c = t; c < clusters.size(); c += threadCount)
                clusters[c] = builder.buildCluster(c);
        });
    for (std::thread& thread : threads)
        thread.join();
    LightRows rows;
    for (const ClusterRows& cluster : clusters)
        append(rows, cluster, kNormalClassCount);
    append(rows, builder.buildOutside(), 1);
    rows.points = builder.takePoints();
    return rows;
}

} // namespace q3rt
