// Cameras, culling, portals and order of drawing: pure CPU.

#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "renderer_vk/draw_list.hpp"
#include "renderer_vk/flares.hpp"
#include "renderer_vk/portal.hpp"
#include "renderer_vk/shadow_volume.hpp"
#include "renderer_vk/sky.hpp"
#include "renderer_vk/view_setup.hpp"

namespace q3rt {
namespace {

constexpr float kTolerance = 1e-4f; // of positions of a few hundred units in float

RasterView viewAt(const SceneView& scene) {
    RasterView view = makeMainView(scene, 4.0f);
    view.farQu = 2048;
    updateProjection(view);
    return view;
}

TEST(RasterView, ProjectionPutsPointsWhereTheFieldOfViewSays) {
    SceneView scene;
    scene.fovXDegrees = scene.fovYDegrees = 90;
    const RasterView view = viewAt(scene);
    // 45 degrees to the left and up at depth 100: the top-left corner; y points down in Vulkan.
    const vec4 corner = view.clipFromWorld * vec4(100, 100, 100, 1);
    EXPECT_NEAR(corner.x / corner.w, -1.0f, kTolerance);
    EXPECT_NEAR(corner.y / corner.w, -1.0f, kTolerance);
    const vec4 nearPoint = view.clipFromWorld * vec4(4, 0, 0, 1), farPoint = view.clipFromWorld * vec4(2048, 0, 0, 1);
    EXPECT_NEAR(nearPoint.z / nearPoint.w, 0.0f, kTolerance);
    EXPECT_NEAR(farPoint.z / farPoint.w, 1.0f, kTolerance);
}

TEST(RasterView, CullingAgreesWithProjection) {
    SceneView scene;
    scene.fovXDegrees = 90;
    scene.fovYDegrees = 70;
    const RasterView view = viewAt(scene);
    std::mt19937 generator(7);
    std::uniform_real_distribution<float> place(-400, 400), size(1, 40);
    int outside = 0, checked = 0;
    for (int i = 0; i < 4000; ++i) {
        const vec3 center(place(generator), place(generator), place(generator));
        const vec3 half(size(generator), size(generator), size(generator));
        const CullResult box = cullBox(view, Bounds{center - half, center + half});
        const CullResult sphere = cullSphere(view, center, glm::length(half));
        const vec4 clip = view.clipFromWorld * vec4(center, 1);
        const bool seen = clip.w > 0 && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w;
        if (box == CullResult::Outside) {
            EXPECT_FALSE(seen) << "a box whose centre is on the screen was culled";
            ++outside;
        }
        if (sphere == CullResult::Outside) {
            EXPECT_EQ(box, CullResult::Outside) << "the sphere holds the box";
        }
        ++checked;
    }
    EXPECT_EQ(checked, 4000);
    EXPECT_GT(outside, 1000);
    EXPECT_LT(outside, 3900);
}

TEST(RasterView, SortKeysFollowRankEntityFogLight) {
    EXPECT_LT(makeSortKey(1, -1, 5, true), makeSortKey(2, 0, 0, false)) << "rank first";
    EXPECT_LT(makeSortKey(3, 900, 5, true), makeSortKey(3, -1, 0, false)) << "the world after all entities";
    EXPECT_LT(makeSortKey(3, 5000, 0, false), makeSortKey(3, -1, 0, false)) << "also after very many";
    EXPECT_LT(makeSortKey(3, 1, 9, true), makeSortKey(3, 2, 0, false)) << "entity before fog";
    EXPECT_LT(makeSortKey(3, 1, 0, true), makeSortKey(3, 1, 1, false)) << "fog before light";
    EXPECT_LT(makeSortKey(3, 1, 1, false), makeSortKey(3, 1, 1, true));
}

SceneEntity portalEntity(const vec3& origin, const vec3& camera) {
    SceneEntity entity;
    entity.kind = EntityKind::PortalSurface;
    entity.orientation.origin = origin;
    entity.oldOrigin = camera;
    return entity;
}

// A wall at x = 200 that faces the eye at the origin.
const Plane kWall{vec3(-1, 0, 0), -200};

TEST(RasterPortal, EntityWithin64UnitsOfThePlaneIsUsed) {
    SceneView scene;
    const RasterView view = viewAt(scene);
    for (const auto& [distance, used] : {std::pair(0.0f, true), {60.0f, true}, {64.0f, true}, {70.0f, false}}) {
        const vec3 origin(200 - distance, 0, 0);
        const SceneEntity entity = portalEntity(origin, vec3(0, 1000, 0));
        EXPECT_EQ(makePortalView(view, kWall, kWall, std::span(&entity, 1)).has_value(), used) << distance;
    }
}

TEST(RasterPortal, MirrorReflectsTheEyeAndTheAxes) {
    SceneView scene;
    scene.view.origin = vec3(50, 10, 20);
    const RasterView view = viewAt(scene);
    const SceneEntity entity = portalEntity(vec3(200, 0, 0), vec3(200, 0, 0));
    const auto mirror = makePortalView(view, kWall, kWall, std::span(&entity, 1));
    ASSERT_TRUE(mirror.has_value());
    EXPECT_TRUE(mirror->mirrored);
    EXPECT_NEAR(glm::distance(mirror->eye.origin, vec3(350, 10, 20)), 0.0f, kTolerance);
    EXPECT_NEAR(glm::distance(mirror->eye.axis[0], vec3(-1, 0, 0)), 0.0f, kTolerance);
    EXPECT_NEAR(glm::distance(mirror->eye.axis[1], vec3(0, 1, 0)), 0.0f, kTolerance);
    EXPECT_NEAR(glm::distance(mirror->eye.axis[2], vec3(0, 0, 1)), 0.0f, kTolerance);
    // What is behind the mirror is clipped, what is before it stays.
    EXPECT_LT(glm::dot(mirror->clip.normal, vec3(250, 0, 0)), mirror->clip.distance);
    EXPECT_GT(glm::dot(mirror->clip.normal, vec3(100, 0, 0)), mirror->clip.distance);
}

TEST(RasterPortal, RemoteCameraLooksAlongItsEntity) {
    SceneView scene;
    const RasterView view = viewAt(scene);
    const vec3 camera(1000, 2000, 300);
    SceneEntity entity = portalEntity(vec3(200, 0, 0), camera);
    const auto portal = makePortalView(view, kWall, kWall, std::span(&entity, 1));
    ASSERT_TRUE(portal.has_value());
    EXPECT_FALSE(portal->mirrored);
    EXPECT_EQ(portal->pvsOrigin, camera);
    // The eye stands 200 units before the surface: as far behind the camera, which looks along +x.
    EXPECT_NEAR(glm::distance(portal->eye.axis[0], vec3(1, 0, 0)), 0.0f, kTolerance);
    EXPECT_NEAR(glm::distance(portal->eye.origin, camera - vec3(200, 0, 0)), 0.0f, kTolerance);
    EXPECT_NEAR(glm::distance(glm::cross(portal->eye.axis[0], portal->eye.axis[1]), portal->eye.axis[2]), 0.0f,
                kTolerance);
}

TEST(RasterPortal, HiddenAndFarSurfacesGiveNoView) {
    SceneView scene;
    const RasterView view = viewAt(scene);
    const auto visible = [&](const vec3& offset, const vec3& normal, float range, bool mirror) {
        const vec3 positions[3] = {offset + vec3(0, -40, -40), offset + vec3(0, 40, -40), offset + vec3(0, 0, 40)};
        const vec3 normals[3] = {normal, normal, normal};
        const uint32_t indices[3] = {0, 1, 2};
        return portalVisible(view, {positions, normals, indices, kWall}, range, mirror);
    };
    EXPECT_TRUE(visible(vec3(200, 0, 0), vec3(-1, 0, 0), 256, false));
    EXPECT_FALSE(visible(vec3(200, 0, 0), vec3(1, 0, 0), 256, false)) << "faces away";
    EXPECT_FALSE(visible(vec3(-200, 0, 0), vec3(1, 0, 0), 256, false)) << "behind the eye";
    EXPECT_FALSE(visible(vec3(300, 0, 0), vec3(-1, 0, 0), 256, false)) << "beyond its range";
    EXPECT_TRUE(visible(vec3(300, 0, 0), vec3(-1, 0, 0), 0, true)) << "mirrors have no range";
}

TEST(RasterPortal, MirrorInAMirrorIsNoMirrorImage) {
    SceneView scene;
    scene.view.origin = vec3(50, 10, 20);
    const SceneEntity near = portalEntity(vec3(200, 0, 0), vec3(200, 0, 0));
    const SceneEntity far = portalEntity(vec3(-100, 0, 0), vec3(-100, 0, 0));
    const Plane behind{vec3(1, 0, 0), -100};
    const auto once = makePortalView(viewAt(scene), kWall, kWall, std::span(&near, 1));
    ASSERT_TRUE(once.has_value());
    const auto twice = makePortalView(*once, behind, behind, std::span(&far, 1));
    ASSERT_TRUE(twice.has_value());
    EXPECT_EQ(twice->portalDepth, 2);
    EXPECT_FALSE(twice->mirrored);
    EXPECT_NEAR(glm::distance(twice->eye.origin, vec3(-550, 10, 20)), 0.0f, kTolerance);
    EXPECT_NEAR(glm::distance(twice->eye.axis[0], vec3(1, 0, 0)), 0.0f, kTolerance);
}

TEST(RasterStereo, EyesAgreeAtTheProjectionsDistance) {
    SceneView scenes[2];
    RasterView views[2];
    for (size_t i = 0; i < 2; ++i) {
        scenes[i].eye = i == 0 ? Eye::Left : Eye::Right;
        views[i] = makeMainView(scenes[i], 4.0f);
        separateEye(views[i], 64, 32); // two units to either side
        updateProjection(views[i]);
    }
    const auto screenX = [&](size_t eye, const mat4& clipFromWorld, const vec3& point) {
        const vec4 clip = clipFromWorld * vec4(point, 1);
        EXPECT_GT(clip.w, 0) << eye;
        return clip.x / clip.w;
    };
    const auto apart = [&](const vec3& point) {
        return screenX(0, views[0].clipFromWorld, point) - screenX(1, views[1].clipFromWorld, point);
    };
    EXPECT_NEAR(apart(vec3(64, 10, 5)), 0, kTolerance);
    EXPECT_GT(apart(vec3(32, 10, 5)), 0.01f) << "near things stand further right for the left eye";
    EXPECT_LT(apart(vec3(640, 10, 5)), -0.01f);
    // Weapons: no difference at the near plane, and hardly any a little further.
    const vec3 held(12, 2, -3);
    EXPECT_LT(std::abs(screenX(0, views[0].clipFromWorldNear, held) - screenX(1, views[1].clipFromWorldNear, held)),
              std::abs(apart(held)));
    for (const RasterView& view : views) {
        const vec4 edge = inverse(view.clipFromWorld) * vec4(1, 0, 0.5f, 1); // on the right side of the picture
        const vec3 point = vec3(edge) / edge.w;
        for (const Plane& plane : view.frustum)
            EXPECT_GT(glm::dot(plane.normal, point) - plane.distance, -0.01f)
                << "the frustum's sides are the picture's";
    }
}

TEST(RasterFlares, FadeInAndOutAfterTheAnswers) {
    FlareFades fades;
    const FlareKey key{7, 1, false};
    uint64_t frame = 0;
    int timeMs = 1000;
    const auto next = [&](std::optional<bool> answer) {
        fades.beginFrame(++frame);
        if (answer) fades.answer(key, frame - 1, *answer);
        return fades.strength(key, timeMs += 20, 7);
    };
    EXPECT_EQ(next(std::nullopt), 0) << "not seen yet";
    EXPECT_NEAR(next(true), 0.007f, 1e-4f) << "fades in from a millisecond before";
    EXPECT_NEAR(next(std::nullopt), 0.147f, 1e-4f);
    for (int i = 0; i < 10; ++i)
        next(std::nullopt);
    EXPECT_EQ(next(true), 1);
    EXPECT_NEAR(next(false), 0.993f, 1e-4f);
    EXPECT_NEAR(next(false), 0.853f, 1e-4f);
    ++frame; // a frame without it
    fades.beginFrame(++frame);
    EXPECT_EQ(fades.size(), 0u);
    fades.strength(key, timeMs, 7);
    fades.answer(key, frame - 1, true);
    EXPECT_EQ(fades.strength(key, timeMs, 7), 0) << "an answer to an earlier flare";
}

TEST(RasterFlares, StandWhereTheirLampDoes) {
    SceneView scene;
    scene.width = 640;
    scene.height = 480;
    scene.fovXDegrees = scene.fovYDegrees = 90;
    const RasterView view = viewAt(scene);
    const auto place = placeFlare(view, vec3(100, 50, 50)); // a quarter of the picture left and up of its middle
    ASSERT_TRUE(place.has_value());
    EXPECT_EQ(place->x, 160);
    EXPECT_EQ(place->y, 360);
    EXPECT_NEAR(place->depthQu, 100, kTolerance);
    EXPECT_FALSE(placeFlare(view, vec3(100, 101, 0)).has_value());
    EXPECT_FALSE(placeFlare(view, vec3(-100, 0, 0)).has_value());
    const FlareLook near = flareLook(64, 640, 40, 150), far = flareLook(1000, 640, 40, 150);
    EXPECT_NEAR(near.halfSizePixels, 120, kTolerance);
    EXPECT_NEAR(far.halfSizePixels, 45.12f, 1e-3f);
    EXPECT_GT(near.intensity, far.intensity);
    EXPECT_NEAR(flareLook(64, 640, 40, 0).intensity, near.intensity, 1e-6f) << "0 stands for the default";
}

TEST(RasterLights, SurfacesKeepLightsThatDoNotReachTheirLeafAnyMore) {
    World world;
    world.bsp.leafs.resize(2);
    world.bsp.planes = {{vec3(1, 0, 0), 0}};
    world.bsp.nodes.resize(1);
    world.bsp.nodes[0].plane = 0;
    world.bsp.nodes[0].children[0] = -1; // x > 0
    world.bsp.nodes[0].children[1] = -2;
    VisibleWorld visible;
    visible.surfaces = {0, 1};
    visible.surfaceLeaf = {0, 1};
    SurfaceLights lights(2, 2);
    const auto lightAt = [](float x) {
        SceneLight light;
        light.origin = vec3(x, 0, 0);
        light.radius = 100;
        return light;
    };
    const std::vector<SceneLight> both = {lightAt(300), lightAt(0)};
    lights.findReached(world, visible, both);
    EXPECT_EQ(lights.reaching(0).size(), 2u);
    ASSERT_EQ(lights.reaching(1).size(), 1u);
    EXPECT_EQ(lights.reaching(1)[0].second, 1u);
    const uint32_t second[] = {1};
    lights.setTouching(1, second);
    lights.findReached(world, visible, std::span(both).first(1));
    EXPECT_TRUE(lights.reaching(1).empty());
    ASSERT_EQ(lights.touching(1).size(), 1u);
    EXPECT_EQ(lights.touching(1)[0], 1u);
}

TEST(RasterShadows, VolumeStandsOnTheOutlineOfWhatFacesTheLight) {
    // A square of two triangles, and the same turned away: the outline is the first one's four sides.
    std::vector<Vertex> vertices(8), sides;
    for (size_t i = 0; i < 8; ++i)
        vertices[i].position = vec3(i & 1 ? 1 : 0, i & 2 ? 1 : 0, i & 4 ? 5 : 0);
    const std::vector<uint32_t> indices = {10, 11, 12, 12, 11, 13, 16, 15, 14, 16, 17, 15};
    std::vector<uint32_t> triangles;
    ShadowVolumeBuilder().append(vertices, indices, 10, vec3(0, 0, 1), sides, triangles);
    EXPECT_EQ(triangles.size(), 4u * 6u);
    float lowest = 0;
    for (const Vertex& vertex : sides) {
        EXPECT_TRUE(vertex.position.z == 0 || vertex.position.z == -kShadowLengthQu) << vertex.position.z;
        lowest = std::min(lowest, vertex.position.z);
    }
    EXPECT_EQ(lowest, -kShadowLengthQu);
}

TEST(RasterSky, CoverageIsRoundedOutwardToBlocks) {
    SkyCoverage coverage;
    coverage.clear();
    // On face +x: s = -y/x, t = z/x.
    coverage.addTriangle(vec3(100, -10, 10), vec3(100, -30, 10), vec3(100, -10, 40));
    const auto range = coverage.blocks(0);
    EXPECT_EQ(range.firstS, 4);
    EXPECT_EQ(range.lastS, 6);
    EXPECT_EQ(range.firstT, 4);
    EXPECT_EQ(range.lastT, 6);
    for (int face = 1; face < kSkyFaces; ++face)
        EXPECT_TRUE(coverage.blocks(face).empty()) << face;
}

TEST(RasterSky, BlocksShowClockwiseFromTheEye) {
    SkyCoverage coverage;
    coverage.clear();
    const float far = 100;
    int triangles = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {-1.0f, 1.0f}) {
            vec3 a(far), b(-far), c(far);
            a[axis] = b[axis] = c[axis] = sign * far;
            a[(axis + 1) % 3] = -far;
            coverage.addTriangle(a, b, c);
        }
    }
    for (int face = 0; face < kSkyFaces; ++face) {
        std::vector<Vertex> vertices;
        std::vector<uint32_t> indices;
        appendSkyFace(coverage, face, vec3(0), 100, 0, vertices, indices);
        for (size_t i = 0; i + 2 < indices.size(); i += 3) {
            const vec3 &p = vertices[indices[i]].position, &q = vertices[indices[i + 1]].position,
                       &r = vertices[indices[i + 2]].position;
            // Clockwise seen from the origin: the counter-clockwise normal points away from the eye.
            EXPECT_GT(glm::dot(glm::cross(q - p, r - p), p), 0.0f) << "face " << face;
            ++triangles;
        }
    }
    EXPECT_GE(triangles, 6 * 64);
}

TEST(RasterSky, CloudsOverheadAreAtARightAngle) {
    const vec2 st = cloudCoordinates(vec3(0, 0, 1), 512);
    EXPECT_NEAR(st.x, 1.5707963f, 1e-6f);
    EXPECT_NEAR(st.y, 1.5707963f, 1e-6f);
    EXPECT_LT(cloudCoordinates(vec3(1, 0, 0.2f), 512).x, st.x);
}

} // namespace
} // namespace q3rt
