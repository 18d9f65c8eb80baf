// buildViewGeometry: what is in a view, and where (spec of models 2, 4, 7).

#include <tuple>

#include <gtest/gtest.h>

#include "md3_builder.hpp"
#include "scene/entity_geometry.hpp"
#include "scene/world_math.hpp"
#include "scene_fixture.hpp"

namespace q3rt::test {
namespace {

class EntityGeometryTest : public testing::Test {
  protected:
    MemoryFiles m_files;
    std::unique_ptr<SceneLibraries> m_libraries;
    std::unique_ptr<ModelLibrary> m_models;
    FrameCommands m_frame;
    SceneView m_view;
    ViewGeometrySettings m_settings;
    ViewGeometry m_geometry;
    World m_world;
    int m_model = 0, m_shader = 0;

    void SetUp() override {
        m_files.addText("scripts/a.shader",
                        "a/plain { { map $whiteimage } }\n"
                        "a/moving { deformVertexes move 0 0 8 sin 1 0 0 0\n { map $whiteimage } }\n");
        Md3TestFrame low, high;
        high.height = 8;
        m_files.files["models/a.md3"] = buildMd3({low, high}, "a/plain");
        m_libraries = std::make_unique<SceneLibraries>(m_files);
        m_models = std::make_unique<ModelLibrary>(m_files, m_libraries->materials);
        m_model = m_models->registerModel("models/a.md3");
        m_shader = m_libraries->materials.registerHandle("a/plain", lightmapContext::k2D);
        m_view.width = 640;
        m_view.height = 480;
        m_view.timeMs = 1000;
        m_world.bsp.models.resize(3);
        m_world.bsp.leafs.resize(1);
        m_models->addInlineModels(m_world);
    }

    SceneEntity& add(EntityKind kind) {
        SceneEntity entity;
        entity.kind = kind;
        entity.customShader = kind == EntityKind::Model ? 0 : m_shader;
        entity.model = m_model;
        m_frame.entities.push_back(entity);
        m_view.entityCount = static_cast<uint32_t>(m_frame.entities.size());
        return m_frame.entities.back();
    }

    const ViewGeometry& build(bool withWorld = false) {
        buildViewGeometry(m_frame, m_view, m_view.view, withWorld ? &m_world : nullptr, *m_models,
                          m_libraries->materials, m_settings, m_geometry);
        return m_geometry;
    }
    vec3 vertex(size_t i) const { return m_geometry.vertices[i].position; }
};

TEST_F(EntityGeometryTest, ShadowsAreCastByWhoAsksForThem) {
    m_settings.projectionShadow = static_cast<MaterialId>(m_shader);
    const auto surfaces = [&](Shadows shadows, uint32_t flags) {
        m_settings.shadows = shadows;
        m_frame.entities.clear();
        add(EntityKind::Model).flags = flags;
        return build().surfaces;
    };
    const auto shadowed = surfaces(Shadows::Projected, entityFlag::kShadowPlane);
    ASSERT_EQ(shadowed.size(), 2u);
    EXPECT_EQ(shadowed[1].material, m_settings.projectionShadow);
    EXPECT_EQ(surfaces(Shadows::Projected, 0).size(), 1u);
    const auto own = surfaces(Shadows::Projected, entityFlag::kShadowPlane | entityFlag::kThirdPerson);
    ASSERT_EQ(own.size(), 1u) << "one's own body casts a shadow and is not seen";
    EXPECT_EQ(own[0].material, m_settings.projectionShadow);
    EXPECT_TRUE(surfaces(Shadows::Volume, 0)[0].castsVolume);
    EXPECT_FALSE(surfaces(Shadows::Volume, entityFlag::kNoShadow)[0].castsVolume);
    EXPECT_FALSE(surfaces(Shadows::Volume, entityFlag::kDepthHack)[0].castsVolume);
    EXPECT_TRUE(surfaces(Shadows::Volume, entityFlag::kThirdPerson).empty());
}

TEST_F(EntityGeometryTest, ModelsOutsideThePlanesAreNotAnimated) {
    const Plane ahead{vec3(1, 0, 0), 1000};
    m_settings.cullPlanes = std::span(&ahead, 1);
    add(EntityKind::Model);
    EXPECT_TRUE(build().vertices.empty());
    m_frame.entities[0].orientation.origin = vec3(2000, 0, 0);
    EXPECT_FALSE(build().vertices.empty());
}

TEST_F(EntityGeometryTest, SurfacesThatNoPixelShowsAreNotAnimated) {
    // A column for each 100 qu of y at x = 1000, the eye at the origin: columns' middles at y = +-50.
    mat4& clip = m_settings.picture.clipFromWorld;
    clip = mat4(0.0f);
    clip[1][0] = clip[2][1] = 1.0f;
    clip[0][2] = clip[0][3] = 1.0f;
    m_settings.picture.sizePx = vec2(20, 20);
    SceneEntity& entity = add(EntityKind::Model);
    const Orientation facing{{}, {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}}; // the triangle faces the eye
    entity.orientation = facing;
    const auto shownAt = [&](const vec3& origin) {
        entity.orientation.origin = origin;
        return !build().vertices.empty();
    };
    EXPECT_TRUE(shownAt({1000, 48, 48})) << "over a pixel's middle";
    EXPECT_FALSE(shownAt({1000, 60, 48})) << "between columns";
    EXPECT_FALSE(shownAt({1000, 48, 60})) << "between rows";
    EXPECT_FALSE(shownAt({1000, 1048, 48})) << "beside the picture";
    std::swap(entity.orientation.axis[0], entity.orientation.axis[1]);
    EXPECT_FALSE(shownAt({1000, 48, 48})) << "its back to the eye";
    entity.orientation = {};
    EXPECT_TRUE(shownAt({-4, 0, 0})) << "about the eye";
    entity.orientation = facing;
    entity.flags = entityFlag::kDepthHack;
    m_settings.picture.clipFromWorldHeld = clip;
    m_settings.picture.clipFromWorldHeld[1][0] = 0.8f;
    EXPECT_TRUE(shownAt({1000, 60, 48})) << "held in the hand: the view is another";
    entity.flags = 0;
    m_settings.shadows = Shadows::Volume;
    EXPECT_TRUE(shownAt({1000, 60, 48})) << "its shadow may be seen";
    m_settings.shadows = Shadows::None;
    entity.frame = 1;
    entity.backLerp = 1.5f;
    EXPECT_FALSE(shownAt({1000, 60, 48}));
    EXPECT_TRUE(shownAt({1000, 48, 48})) << "beyond both frames";
}

TEST_F(EntityGeometryTest, PolysThatNoPixelShowsAreLeftOut) {
    mat4& clip = m_settings.picture.clipFromWorld; // as above
    clip = mat4(0.0f);
    clip[1][0] = clip[2][1] = 1.0f;
    clip[0][2] = clip[0][3] = 1.0f;
    m_settings.picture.sizePx = vec2(20, 20);
    const auto shownAt = [&](float y) {
        m_frame.polyVertices = {{{1000, y, 44}, {}, {}}, {{1000, y + 8, 44}, {}, {}}, {{1000, y, 56}, {}, {}}};
        m_frame.polys = {{m_shader, 0, 3}};
        m_view.polyCount = 1;
        return !build().surfaces.empty();
    };
    EXPECT_TRUE(shownAt(46));
    EXPECT_FALSE(shownAt(60)) << "between columns";
    EXPECT_FALSE(shownAt(1046)) << "beside the picture";
    m_settings.picture.sizePx = vec2(0);
    EXPECT_TRUE(shownAt(60)) << "there is no picture to judge by";
}

TEST_F(EntityGeometryTest, ModelIsBlendedBetweenFrames) {
    SceneEntity& entity = add(EntityKind::Model);
    entity.frame = 1;
    entity.backLerp = 0.25f;
    entity.orientation.origin = {100, 0, 0};
    build();
    ASSERT_EQ(m_geometry.surfaces.size(), 1u);
    const EntitySurface& surface = m_geometry.surfaces[0];
    EXPECT_EQ(surface.entity, 1u);
    EXPECT_EQ(surface.vertexCount, 3u);
    EXPECT_EQ(surface.indexCount, 3u);
    EXPECT_EQ(surface.backLerp, 0.25f);
    EXPECT_FALSE(surface.deformed);
    EXPECT_EQ(vertex(0), vec3(0, 0, 6));
    EXPECT_EQ(m_geometry.vertices[0].color, 0xffffffffu);
    const EntityRecord& record = m_geometry.entities[1];
    EXPECT_EQ(vec3(record.worldFromModel * vec4(1, 2, 3, 1)), vec3(101, 2, 3));
    EXPECT_EQ(record.eyeInModel, vec3(-100, 0, 0));
    EXPECT_EQ(record.worldBounds.mins, vec3(92, -8, -8));
    EXPECT_TRUE(record.stage.hasEntity);
    EXPECT_FALSE(m_geometry.entities[0].stage.hasEntity);
}

TEST_F(EntityGeometryTest, WhoSeesWhom) {
    add(EntityKind::Model).flags = entityFlag::kThirdPerson;
    add(EntityKind::Model).flags = entityFlag::kFirstPerson;
    EXPECT_EQ(build().surfaces.size(), 1u);
    EXPECT_EQ(m_geometry.entities[1].sceneIndex, 1);
    m_settings.isPortalView = true;
    EXPECT_EQ(build().surfaces.size(), 1u);
    EXPECT_EQ(m_geometry.entities[1].sceneIndex, 0);
    m_settings.keepHiddenEntities = true;
    EXPECT_EQ(build().surfaces.size(), 2u);
    m_settings.drawEntities = false;
    EXPECT_EQ(build().surfaces.size(), 0u);
}

TEST_F(EntityGeometryTest, DeformedModelIsMarkedAndMoved) {
    add(EntityKind::Model).customShader = m_libraries->materials.registerHandle("a/moving", lightmapContext::kNone);
    build();
    EXPECT_TRUE(m_geometry.surfaces[0].deformed);
    EXPECT_EQ(vertex(0), vec3(0, 0, 8));
    EXPECT_EQ(m_geometry.entities[1].worldBounds.maxs.z, 8);
}

TEST_F(EntityGeometryTest, OnlyTheFirstEntityOfAnInlineModelIsDrawn) {
    for (int i = 0; i < 2; ++i) {
        SceneEntity& entity = add(EntityKind::Model);
        entity.model = m_models->registerModel("*2");
        entity.flags = entityFlag::kThirdPerson; // brush models don't mind
        entity.orientation.origin.x = static_cast<float>(i);
    }
    build(true);
    ASSERT_EQ(m_geometry.entities.size(), 2u);
    EXPECT_EQ(m_geometry.entities[1].inlineModel, 2);
    EXPECT_EQ(m_geometry.entities[1].worldFromModel[3].x, 0);
    EXPECT_TRUE(m_geometry.surfaces.empty());
}

TEST_F(EntityGeometryTest, BadModelShowsItsAxes) {
    add(EntityKind::Model).model = 0;
    m_frame.entities[0].orientation.origin = {50, 5, 5};
    build();
    ASSERT_EQ(m_geometry.surfaces.size(), 1u);
    EXPECT_EQ(m_geometry.surfaces[0].indexCount, 3 * 6u);
    EXPECT_EQ(m_geometry.entities[1].worldFromModel, mat4(1.0f));
}

TEST_F(EntityGeometryTest, SpriteIsASquareThatTurnsCounterClockwise) {
    SceneEntity& entity = add(EntityKind::Sprite);
    entity.radius = 10;
    entity.orientation.origin = {100, 0, 0};
    build();
    EXPECT_EQ(vertex(0), vec3(100, 10, 10));
    EXPECT_EQ(vertex(2), vec3(100, -10, -10));
    m_frame.entities[0].rotationDegrees = 90;
    build();
    EXPECT_NEAR(glm::distance(vertex(0), vec3(100, 10, -10)), 0, 1e-4f) << "upper left goes to lower left";
    m_settings.mirrored = true;
    m_frame.entities[0].rotationDegrees = 0;
    build();
    EXPECT_EQ(vertex(0), vec3(100, -10, 10));
}

TEST_F(EntityGeometryTest, RailCoreRunsFromOldOriginWithADarkFirstVertex) {
    SceneEntity& entity = add(EntityKind::RailCore);
    entity.oldOrigin = {100, 50, 0};
    entity.orientation.origin = {100, -50, 0};
    entity.color = {200, 100, 80, 7};
    build();
    ASSERT_EQ(m_geometry.vertices.size(), 4u);
    EXPECT_NEAR(glm::distance(vertex(0), vertex(1)), 12, 1e-4f);
    EXPECT_EQ(unpackColor(m_geometry.vertices[0].color), U8vec4(50, 25, 20, 255));
    EXPECT_EQ(unpackColor(m_geometry.vertices[3].color), U8vec4(200, 100, 80, 255));
    EXPECT_FLOAT_EQ(m_geometry.vertices[2].st.x, 100.0f / 256);
}

TEST_F(EntityGeometryTest, RailRingsDropOneSegment) {
    SceneEntity& entity = add(EntityKind::RailRings);
    for (const auto& [length, rings] : {std::pair{20.0f, 1u}, {95.0f, 1u}, {100.0f, 2u}, {320.0f, 9u}}) {
        entity.oldOrigin = {0, 0, 0};
        entity.orientation.origin = {length, 0, 0};
        EXPECT_EQ(build().vertices.size(), rings * 4) << length;
    }
    EXPECT_NEAR(vertex(0).x, 32, 1e-4f) << "the first of several is one segment in";
    EXPECT_NEAR(glm::length(vec2(vertex(0).y, vertex(0).z)), 4, 1e-4f);
}

TEST_F(EntityGeometryTest, LightningIsFourQuadsAboutItsLine) {
    SceneEntity& entity = add(EntityKind::Lightning);
    entity.orientation.origin = {100, 50, 0};
    entity.oldOrigin = {100, -50, 0};
    build();
    ASSERT_EQ(m_geometry.vertices.size(), 16u);
    for (size_t quad = 0; quad < 4; ++quad) {
        EXPECT_NEAR(glm::distance(vertex(4 * quad), vertex(4 * quad + 1)), 16, 1e-3f);
        EXPECT_NEAR(glm::distance((vertex(4 * quad) + vertex(4 * quad + 1)) * 0.5f, vec3(100, 50, 0)), 0, 1e-3f);
    }
}

TEST_F(EntityGeometryTest, BeamStartsAtTheWorldOrigin) {
    SceneEntity& entity = add(EntityKind::Beam);
    entity.orientation.origin = {500, 0, 0};
    entity.oldOrigin = {600, 0, 0};
    build();
    ASSERT_EQ(m_geometry.vertices.size(), 24u);
    EXPECT_NEAR(vertex(0).x, 0, 1e-4f);
    EXPECT_NEAR(vertex(1).x, 100, 1e-4f);
    EXPECT_NEAR(glm::length(vec2(vertex(0).y, vertex(0).z)), 4, 1e-4f);
}

TEST_F(EntityGeometryTest, PolysAreFansOfTheWorld) {
    for (const vec3& corner : {vec3(0, 0, 0), vec3(0, 8, 0), vec3(8, 8, 0), vec3(8, 0, 0)}) {
        m_frame.polyVertices.push_back({corner, vec2(corner), U8vec4(1, 2, 3, 4)});
    }
    m_frame.polys = {{m_shader, 0, 4}, {0, 0, 4}};
    m_view.polyCount = 2;
    FogVolume fog;
    fog.bounds = {vec3(8, 8, 0), vec3(100, 100, 100)}; // touches with a corner: enough for polys
    m_world.fogs = {FogVolume{}, fog};
    build(true);
    ASSERT_EQ(m_geometry.surfaces.size(), 1u) << "shader 0 draws nothing";
    const EntitySurface& surface = m_geometry.surfaces[0];
    EXPECT_TRUE(surface.isPoly);
    EXPECT_EQ(surface.entity, 0u);
    EXPECT_EQ(surface.fog, 1);
    EXPECT_EQ(m_geometry.indices, (std::vector<uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(m_geometry.vertices[0].normal, vec3(0, 0, 1)) << "the side that shows clockwise";
    EXPECT_EQ(unpackColor(m_geometry.vertices[0].color), U8vec4(1, 2, 3, 4));
}

TEST_F(EntityGeometryTest, ModelFogNeedsTheSphereInside) {
    FogVolume fog;
    fog.bounds = {vec3(100, -50, -50), vec3(200, 50, 50)};
    m_world.fogs = {FogVolume{}, fog};
    SceneEntity& entity = add(EntityKind::Model);
    entity.orientation.origin = {92, 0, 0}; // radius 8: touches only
    EXPECT_EQ(build(true).surfaces[0].fog, 0);
    entity.orientation.origin = {93, 0, 0};
    EXPECT_EQ(build(true).surfaces[0].fog, 1);
    m_view.flags = viewFlag::kNoWorldModel;
    EXPECT_EQ(build(true).surfaces[0].fog, 0);
}

TEST_F(EntityGeometryTest, DeformedWorldSurfacesAreCopiedIntoTheirRecord) {
    const MaterialId moving = m_libraries->materials.find("a/moving", lightmapContext::kByVertex);
    for (const int model : {0, 1, 2}) {
        WorldSurface surface;
        surface.material = moving;
        surface.bspModel = model;
        surface.vertexCount = 3;
        surface.indexCount = 3;
        surface.firstVertex = static_cast<uint32_t>(m_world.vertices.size());
        surface.firstIndex = surface.firstVertex;
        for (uint32_t i = 0; i < 3; ++i) {
            m_world.vertices.push_back(Vertex{vec3(i == 1, i == 2, 0)});
            m_world.indices.push_back(surface.firstVertex + i);
        }
        m_world.surfaces.push_back(surface);
    }
    m_world.materialGroups = {{moving, {0, 1, 2}}};
    add(EntityKind::Model).model = m_models->registerModel("*2");
    build(true);
    ASSERT_EQ(m_geometry.surfaces.size(), 2u) << "submodel 1 is not in the view";
    EXPECT_EQ(m_geometry.surfaces[0].worldSurface, 0);
    EXPECT_EQ(m_geometry.surfaces[0].entity, 0u);
    EXPECT_EQ(m_geometry.surfaces[1].worldSurface, 2);
    EXPECT_EQ(m_geometry.surfaces[1].entity, 1u);
    EXPECT_EQ(vertex(0).z, 8);
    EXPECT_EQ(m_geometry.indices[3], m_geometry.surfaces[1].firstVertex);
    m_view.flags = viewFlag::kNoWorldModel;
    EXPECT_EQ(build(true).surfaces.size(), 1u) << "brush models also show without the world";
}

TEST_F(EntityGeometryTest, SteadyFrameKeepsItsMemory) {
    add(EntityKind::Model);
    add(EntityKind::Model).customShader = m_libraries->materials.registerHandle("a/moving", lightmapContext::kNone);
    add(EntityKind::Model).model = m_models->registerModel("*2");
    for (const EntityKind kind :
         {EntityKind::Sprite, EntityKind::Beam, EntityKind::RailCore, EntityKind::RailRings, EntityKind::Lightning}) {
        add(kind).oldOrigin = {300, 20, 10};
    }
    m_frame.lights.push_back({vec3(0, 0, 100), 50, vec3(1), false});
    m_view.lightCount = 1;
    build(true);
    const auto memory = [&] {
        return std::tuple(m_geometry.entities.data(), m_geometry.surfaces.data(), m_geometry.vertices.data(),
                          m_geometry.indices.data(), m_geometry.batchVertices.data(), m_geometry.batchIndices.data(),
                          m_geometry.recordOfInlineModel.data());
    };
    const auto before = memory();
    build(true);
    EXPECT_EQ(memory(), before);
    EXPECT_EQ(m_geometry.entities.size(), 9u);
}

} // namespace
} // namespace q3rt::test
