#include "renderer_vk/surface_lights.hpp"

#include <algorithm>
#include <cmath>

namespace q3rt {

bool lightTouchesSurface(const WorldSurface& surface, const SceneLight& light) {
    switch (surface.type) {
    case BspSurfaceType::Planar:
        return std::abs(glm::dot(light.origin, surface.plane.normal) - surface.plane.distance) <= light.radius;
    case BspSurfaceType::Patch:
        return glm::all(glm::greaterThanEqual(light.origin + light.radius, surface.bounds.mins)) &&
               glm::all(glm::lessThanEqual(light.origin - light.radius, surface.bounds.maxs));
    case BspSurfaceType::TriangleSoup:
        return true;
    case BspSurfaceType::Flare:
        break;
    }
    return false;
}

namespace {

constexpr size_t kUsualLights = 4; // that touch a surface; more make the lists grow

/// Marks the leafs that a light's sphere reaches.
void markLeafs(const World& world, const SceneLight& light, int node, std::vector<uint8_t>& reached) {
    while (node >= 0) {
        const BspNode& n = world.bsp.nodes[static_cast<size_t>(node)];
        const Plane& plane = world.bsp.planes[static_cast<size_t>(n.plane)];
        const float distance = glm::dot(plane.normal, light.origin) - plane.distance;
        const bool front = distance > -light.radius, back = distance < light.radius;
        if (front && back) markLeafs(world, light, n.children[0], reached);
        node = front && !back ? n.children[0] : n.children[1];
    }
    reached[static_cast<size_t>(-1 - node)] = 1;
}

} // namespace

void SurfaceLights::findReached(const World& world, const VisibleWorld& visible, std::span<const SceneLight> lights) {
    m_reached.clear();
    // Packing looks at every surface: no sooner than when it frees as much.
    if (m_lists.size() > 2 * m_listedCount + m_touching.size()) packLists();
    for (size_t l = 0; l < lights.size(); ++l) {
        m_leafs.assign(world.bsp.leafs.size(), 0);
        markLeafs(world, lights[l], world.bsp.nodes.empty() ? -1 : 0, m_leafs);
        for (size_t i = 0; i < visible.surfaces.size(); ++i)
            if (m_leafs[static_cast<size_t>(visible.surfaceLeaf[i])])
                m_reached.emplace_back(static_cast<uint32_t>(i), static_cast<uint32_t>(l));
    }
    std::ranges::sort(m_reached);
}

SurfaceLights::SurfaceLights(size_t surfaceCount, size_t leafCount)
    : m_touching(surfaceCount) {
    m_leafs.reserve(leafCount);
    m_reached.reserve(surfaceCount * kUsualLights);
    // What is listed, as much that is replaced, and a frame's more.
    for (std::vector<uint32_t>* lists : {&m_lists, &m_packed})
        lists->reserve(3 * surfaceCount * kUsualLights + surfaceCount);
}

void SurfaceLights::setTouching(uint32_t surface, std::span<const uint32_t> lights) {
    List& list = m_touching[surface];
    m_listedCount += lights.size() - list.count;
    if (lights.size() > list.count) {
        list.first = static_cast<uint32_t>(m_lists.size());
        m_lists.insert(m_lists.end(), lights.begin(), lights.end());
    } else {
        std::ranges::copy(lights, m_lists.begin() + list.first);
    }
    list.count = static_cast<uint32_t>(lights.size());
}

void SurfaceLights::packLists() {
    m_packed.clear();
    for (List& list : m_touching) {
        const auto first = m_lists.begin() + list.first;
        list.first = static_cast<uint32_t>(m_packed.size());
        m_packed.insert(m_packed.end(), first, first + list.count);
    }
    m_lists.swap(m_packed);
}

std::span<const std::pair<uint32_t, uint32_t>> SurfaceLights::reaching(size_t place) const {
    return std::ranges::equal_range(m_reached, place, {}, [](const auto& pair) { return size_t{pair.first}; });
}

bool brushModelLit(const BspModel& model, const EntityRecord& entity, std::span<const SceneLight> lights) {
    const mat4 modelFromWorld = glm::inverse(entity.worldFromModel);
    return std::ranges::any_of(lights, [&](const SceneLight& light) {
        const vec3 origin(modelFromWorld * vec4(light.origin, 1.0f));
        return glm::all(glm::greaterThanEqual(origin + light.radius, model.mins)) &&
               glm::all(glm::lessThanEqual(origin - light.radius, model.maxs));
    });
}

} // namespace q3rt
