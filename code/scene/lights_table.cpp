// Which triangle lights can matter in which cluster: the map's own visibility applied to lights. A light is only left
// out where it can't be seen: triangles are clipped through the BSP, so that all clusters they touch are known, not
// just those of their corners.

#include <algorithm>
#include <bit>

#include "scene/lights.hpp"

namespace q3rt {
namespace {

/// A triangle this near to a dividing plane counts as on both sides: map compilers move vertices by up to this much.
constexpr float kPlaneSlackQu = 0.125f;

using Polygon = std::vector<vec3>;

/// The part of a convex polygon with dot(normal, p) - distance >= -slack.
Polygon clipToFront(const Polygon& polygon, const vec3& normal, float distance) {
    Polygon kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const float da = glm::dot(normal, a) - distance + kPlaneSlackQu;
        const float db = glm::dot(normal, b) - distance + kPlaneSlackQu;
        if (da >= 0.0f) kept.push_back(a);
        if ((da >= 0.0f) != (db >= 0.0f)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    return kept;
}

/// All clusters that a light touches, ascending.
std::vector<int> findClusters(const World& world, const TriangleLight& light) {
    struct Part {
        int child;
        Polygon polygon;
    };
    std::vector<int> clusters;
    std::vector<Part> open{{world.bsp.nodes.empty() ? -1 : 0, {light.corner, light.corner + 3}}};
    while (!open.empty()) {
        const Part part = std::move(open.back());
        open.pop_back();
        if (part.polygon.empty()) continue;
        if (part.child < 0) {
            const int cluster = world.bsp.leafs[static_cast<size_t>(-1 - part.child)].cluster;
            if (cluster >= 0 && cluster < world.bsp.clusterCount) clusters.push_back(cluster);
            continue;
        }
        const BspNode& node = world.bsp.nodes[static_cast<size_t>(part.child)];
        const Plane& plane = world.bsp.planes[static_cast<size_t>(node.plane)];
        open.push_back({node.children[0], clipToFront(part.polygon, plane.normal, plane.distance)});
        open.push_back({node.children[1], clipToFront(part.polygon, -plane.normal, -plane.distance)});
    }
    std::sort(clusters.begin(), clusters.end());
    clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
    return clusters;
}

/// A set of light numbers.
class LightSetBits {
  public:
    explicit LightSetBits(size_t count)
        : m_words((count + 63) / 64, 0) {}
    void insert(size_t light) { m_words[light / 64] |= uint64_t{1} << (light % 64); }
    void insert(const LightSetBits& other) {
        for (size_t i = 0; i < m_words.size(); ++i) {
            m_words[i] |= other.m_words[i];
        }
    }
    void appendTo(std::vector<uint32_t>& list) const {
        for (size_t i = 0; i < m_words.size(); ++i) {
            for (uint64_t word = m_words[i]; word != 0; word &= word - 1) {
                list.push_back(static_cast<uint32_t>(i * 64 + static_cast<size_t>(std::countr_zero(word))));
            }
        }
    }

  private:
    std::vector<uint64_t> m_words;
};

} // namespace

LightTable buildLightTable(const World& world, const LightSet& lights, bool cull) {
    const size_t count = lights.triangles.size();
    const auto clusterCount = static_cast<size_t>(world.bsp.clusterCount);
    LightSetBits everywhere(count), all(count);
    std::vector<LightSetBits> touching(clusterCount, LightSetBits(count));
    std::vector<char> holdsLight(clusterCount, 0);
    for (size_t i = 0; i < count; ++i) {
        all.insert(i);
        const bool moves = lights.triangles[i].bspModel != 0;
        const std::vector<int> clusters =
            cull && !moves ? findClusters(world, lights.triangles[i]) : std::vector<int>{};
        if (clusters.empty()) everywhere.insert(i);
        for (const int cluster : clusters) {
            touching[static_cast<size_t>(cluster)].insert(i);
            holdsLight[static_cast<size_t>(cluster)] = 1;
        }
    }
    LightTable table;
    table.offset.push_back(0);
    for (size_t row = 0; row < clusterCount; ++row) {
        LightSetBits visible = everywhere;
        for (size_t cluster = 0; cluster < clusterCount; ++cluster) {
            if (!holdsLight[cluster]) continue;
            const int r = static_cast<int>(row), c = static_cast<int>(cluster);
            if (world.bsp.clusterVisible(r, c) || world.bsp.clusterVisible(c, r)) visible.insert(touching[cluster]);
        }
        visible.appendTo(table.lights);
        table.offset.push_back(static_cast<uint32_t>(table.lights.size()));
    }
    all.appendTo(table.lights);
    table.offset.push_back(static_cast<uint32_t>(table.lights.size()));
    return table;
}

} // namespace q3rt
