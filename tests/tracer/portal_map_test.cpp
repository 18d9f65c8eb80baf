// The affine map of a portal is the rasteriser's portal camera, for points and directions alike.

#include <gtest/gtest.h>
#include <random>

#include "renderer_rt/view_portals.hpp"
#include "renderer_vk/portal.hpp"

namespace q3rt {
namespace {

vec3 mapPoint(const RtPortal& portal, const vec3& p, float w) {
    return {glm::dot(portal.rows[0], vec4(p, w)), glm::dot(portal.rows[1], vec4(p, w)),
            glm::dot(portal.rows[2], vec4(p, w))};
}

struct Wall {
    World world;
    WorldSurface surface;
    Material material;
    Wall() {
        surface.plane = {vec3(0.6f, 0.8f, 0.0f), 200};
        surface.indexCount = 3;
        material.isPortal = true;
        material.portalRange = 512;
    }
};

SceneEntity portalEntity(const vec3& at, const vec3& camera) {
    SceneEntity entity;
    entity.kind = EntityKind::PortalSurface;
    entity.orientation.origin = at;
    entity.oldOrigin = camera;
    entity.skinNumber = 30; // roll, degrees
    return entity;
}

TEST(PortalMap, IsTheRasterisersCamera) {
    const Wall wall;
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> place(-500.0f, 500.0f);
    int checked = 0;
    for (const bool mirror : {true, false})
        for (int i = 0; i < 50; ++i, ++checked) {
            const vec3 at = wall.surface.plane.normal * 210.0f;
            const SceneEntity entity =
                portalEntity(at, mirror ? at : vec3(place(generator), place(generator), place(generator)));
            SceneView scene;
            RasterView view;
            view.scene = &scene;
            view.eye.origin = {place(generator), place(generator), place(generator)};
            const auto expected = makePortalView(view, wall.surface.plane, wall.surface.plane, std::span(&entity, 1));
            ASSERT_TRUE(expected.has_value());
            ViewPortals portals;
            portals.begin({std::span(&entity, 1), scene.timeMs});
            ASSERT_EQ(portals.findStatic(wall.world, wall.surface, wall.material, EntityRecord{}), 1u);
            const RtPortal& portal = portals.table()[0];
            // The largest coordinates are 1,000 qu: 1e-3 is some eight roundings of them.
            EXPECT_LT(glm::distance(mapPoint(portal, view.eye.origin, 1), expected->eye.origin), 1e-3f);
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_LT(glm::distance(mapPoint(portal, view.eye.axis[axis], 0), expected->eye.axis[axis]), 1e-5f);
        }
    EXPECT_EQ(checked, 100);
}

TEST(PortalMap, LeadsNowhereWithoutEntityOrRange) {
    Wall wall;
    const vec3 at = wall.surface.plane.normal * 200.0f;
    const SceneEntity far = portalEntity(at * 1.5f, at * 1.5f), camera = portalEntity(at, vec3(0, 900, 0));
    ViewPortals portals;
    portals.begin({std::span(&far, 1), 0});
    EXPECT_EQ(portals.findStatic(wall.world, wall.surface, wall.material, EntityRecord{}), 0u);
    wall.material.portalRange = 0;
    portals.begin({std::span(&camera, 1), 0});
    EXPECT_EQ(portals.findStatic(wall.world, wall.surface, wall.material, EntityRecord{}), 0u);
    wall.material.portalRange = 512;
    EXPECT_EQ(portals.findStatic(wall.world, wall.surface, wall.material, EntityRecord{}), 1u);
    wall.material.isPortal = false;
    EXPECT_EQ(portals.findStatic(wall.world, wall.surface, wall.material, EntityRecord{}), 0u);
}

} // namespace
} // namespace q3rt
