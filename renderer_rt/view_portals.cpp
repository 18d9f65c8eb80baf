#include "renderer_rt/view_portals.hpp"

#include "renderer_vk/portal.hpp"

namespace q3rt {

namespace {

/// Of the first triangle; normal on the side from which it is seen clockwise.
Plane planeOfFirstTriangle(std::span<const Vertex> vertices, std::span<const uint32_t> indices) {
    const vec3 a = vertices[indices[0]].position;
    const vec3 normal = glm::cross(vertices[indices[2]].position - a, vertices[indices[1]].position - a);
    const float length = glm::length(normal);
    if (length == 0) return {vec3(1, 0, 0), 0};
    return {normal / length, glm::dot(normal / length, a)};
}

/// Points in front of the portal to where they are seen in it.
RtPortal makePortal(const PortalFrames& frames) {
    RtPortal portal{};
    for (int row = 0; row < 3; ++row) {
        vec3 linear(0.0f);
        for (int i = 0; i < 3; ++i)
            linear += frames.surface.axis[i] * frames.camera.axis[i][row];
        portal.rows[row] = vec4(linear, frames.camera.origin[row] - glm::dot(linear, frames.surface.origin));
    }
    return portal;
}

} // namespace

void ViewPortals::begin(const PortalScene& scene) {
    m_scene = scene;
    m_table.clear();
}

uint32_t ViewPortals::add(const Plane& modelPlane, const Material& material, const EntityRecord& record) {
    // The entity is looked for with the plane's unrotated normal (spec of world 4.5).
    Plane plane = modelPlane, match = modelPlane;
    if (record.sceneIndex >= 0) {
        const vec3 origin(record.worldFromModel[3]);
        match.distance += glm::dot(match.normal, origin);
        plane.normal = mat3(record.worldFromModel) * modelPlane.normal;
        plane.distance += glm::dot(plane.normal, origin);
    }
    const auto frames = findPortalFrames(plane, match, m_scene.entities, m_scene.timeMs);
    // A portal without a range is never seen through; with one, its own stages cover it from there on.
    if (!frames || (!frames->mirror && material.portalRange <= 0)) return 0;
    m_table.push_back(makePortal(*frames));
    return static_cast<uint32_t>(m_table.size());
}

uint32_t ViewPortals::findStatic(const World& world, const WorldSurface& surface, const Material& material,
                                 const EntityRecord& record) {
    if (!material.isPortal || surface.indexCount < 3) return 0;
    const bool planar = surface.type == BspSurfaceType::Planar;
    return add(planar ? surface.plane
                      : planeOfFirstTriangle(world.vertices,
                                             std::span(world.indices).subspan(surface.firstIndex, surface.indexCount)),
               material, record);
}

uint32_t ViewPortals::findMoving(const World* world, const ViewGeometry& geometry, const EntitySurface& surface,
                                 const Material& material) {
    if (!material.isPortal || surface.indexCount < 3) return 0;
    const EntityRecord& record = geometry.entities[surface.entity];
    // A deformed face keeps the plane that it has in the map.
    if (world && surface.worldSurface >= 0) {
        const WorldSurface& face = world->surfaces[static_cast<size_t>(surface.worldSurface)];
        if (face.type == BspSurfaceType::Planar) return add(face.plane, material, record);
    }
    return add(planeOfFirstTriangle(geometry.vertices,
                                    std::span(geometry.indices).subspan(surface.firstIndex, surface.indexCount)),
               material, record);
}

} // namespace q3rt
