#include "renderer_vk/visibility.hpp"

#include <algorithm>

namespace q3rt {

namespace {

/// -1 wholly behind the plane, 1 wholly in front, 0 both: of an axis-aligned box.
int boxSide(const Plane& plane, const vec3& mins, const vec3& maxs) {
    const vec3 center = (mins + maxs) * 0.5f, half = (maxs - mins) * 0.5f;
    const float reach = glm::dot(glm::abs(plane.normal), half);
    const float distance = glm::dot(plane.normal, center) - plane.distance;
    if (distance >= reach) return 1;
    return distance < -reach ? -1 : 0;
}

} // namespace

WorldVisibility::WorldVisibility(const World& world)
    : m_world(world)
    , m_nodeParent(world.bsp.nodes.size(), -1)
    , m_leafParent(world.bsp.leafs.size(), -1)
    , m_nodeMarked(world.bsp.nodes.size())
    , m_leafMarked(world.bsp.leafs.size())
    , m_surfaceVisible(world.bsp.surfaces.size()) {
    for (size_t i = 0; i < world.bsp.nodes.size(); ++i) {
        for (const int child : world.bsp.nodes[i].children) {
            int& parent =
                child >= 0 ? m_nodeParent[static_cast<size_t>(child)] : m_leafParent[static_cast<size_t>(-1 - child)];
            parent = static_cast<int>(i);
        }
    }
}

void WorldVisibility::markLeafs(const RasterView& view, const VisibilitySettings& settings) {
    if (settings.lockPvs && m_marked) return;
    const int cluster = m_world.clusterOf(view.pvsOrigin);
    const bool all = settings.noVis || cluster < 0;
    if (m_marked && cluster == m_cluster && all == m_markedAll && view.scene->areaMask == m_areaMask) return;
    m_marked = true;
    m_markedAll = all;
    m_cluster = cluster;
    m_areaMask = view.scene->areaMask;
    std::ranges::fill(m_nodeMarked, all ? 1 : 0);
    std::ranges::fill(m_leafMarked, all ? 1 : 0);
    if (all) return;
    for (size_t i = 0; i < m_leafMarked.size(); ++i) {
        const BspLeaf& leaf = m_world.bsp.leafs[i];
        if (leaf.cluster < 0 || !m_world.bsp.clusterVisible(cluster, leaf.cluster)) continue;
        const auto area = static_cast<size_t>(std::max(leaf.area, 0));
        if (area < m_areaMask.size() * 8 && (m_areaMask[area >> 3] & (1u << (area & 7)))) continue;
        m_leafMarked[i] = 1;
        for (int node = m_leafParent[i]; node >= 0 && !m_nodeMarked[static_cast<size_t>(node)];
             node = m_nodeParent[static_cast<size_t>(node)])
            m_nodeMarked[static_cast<size_t>(node)] = 1;
    }
}

void WorldVisibility::addLeaf(int index, VisibleWorld& out) {
    const BspLeaf& leaf = m_world.bsp.leafs[static_cast<size_t>(index)];
    out.bounds.add(Bounds{vec3(leaf.mins), vec3(leaf.maxs)});
    ++out.leafCount;
    for (int i = 0; i < leaf.leafSurfaceCount; ++i) {
        const auto surface =
            static_cast<size_t>(m_world.bsp.leafSurfaces[static_cast<size_t>(leaf.firstLeafSurface + i)]);
        if (m_surfaceVisible[surface] != 0) continue;
        m_surfaceVisible[surface] = 1;
        out.surfaces.push_back(static_cast<uint32_t>(surface));
        out.surfaceLeaf.push_back(index);
    }
}

void WorldVisibility::walk(int node, const RasterView& view, unsigned planes, VisibleWorld& out) {
    while (true) {
        const bool isLeaf = node < 0;
        const auto index = static_cast<size_t>(isLeaf ? -1 - node : node);
        if (!(isLeaf ? m_leafMarked[index] : m_nodeMarked[index])) return;
        const ivec3& mins = isLeaf ? m_world.bsp.leafs[index].mins : m_world.bsp.nodes[index].mins;
        const ivec3& maxs = isLeaf ? m_world.bsp.leafs[index].maxs : m_world.bsp.nodes[index].maxs;
        for (unsigned i = 0; i < view.frustum.size(); ++i) {
            if (!(planes & (1u << i))) continue;
            const int side = boxSide(view.frustum[i], vec3(mins), vec3(maxs));
            if (side < 0) return;
            if (side > 0) planes &= ~(1u << i);
        }
        if (isLeaf) {
            addLeaf(static_cast<int>(index), out);
            return;
        }
        walk(m_world.bsp.nodes[index].children[0], view, planes, out);
        node = m_world.bsp.nodes[index].children[1];
    }
}

void WorldVisibility::findVisible(const RasterView& view, const VisibilitySettings& settings, VisibleWorld& out) {
    out.surfaces.clear();
    out.surfaceLeaf.clear();
    out.bounds = Bounds{};
    out.leafCount = 0;
    markLeafs(view, settings);
    std::ranges::fill(m_surfaceVisible, uint8_t{0});
    const unsigned allPlanes = settings.noCull ? 0u : 0xFu;
    walk(m_world.bsp.nodes.empty() ? -1 : 0, view, allPlanes, out);
}

} // namespace q3rt
