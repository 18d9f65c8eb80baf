// The traps T1 to T8 of the content survey (section 9), each on a map that has it.

#include <cmath>

#include <gtest/gtest.h>

#include "scene/world_build.hpp"
#include "scene_fixture.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

/// A map with small pictures, and what was logged while it loaded.
struct LoadedMap {
    std::unique_ptr<Pk3FileSource> files = openGameData();
    std::unique_ptr<TinyImageFiles> tiny;
    std::unique_ptr<SceneLibraries> libraries;
    std::unique_ptr<World> world;
    LogCapture log;

    explicit LoadedMap(const std::string& map, const WorldSettings& settings = {}) {
        if (!files) return;
        tiny = std::make_unique<TinyImageFiles>(*files);
        libraries = std::make_unique<SceneLibraries>(*tiny);
        world = loadWorld(*tiny, "maps/" + map + ".bsp", libraries->materials, settings);
    }
};

#define LOAD_OR_SKIP(name, ...)                                                                                        \
    const LoadedMap name(__VA_ARGS__);                                                                                 \
    if (!name.files) GTEST_SKIP() << kNoGameData

TEST(Traps, T1NodrawPatchesGiveNoGeometryAndNoLight) {
    LOAD_OR_SKIP(map, "am_thornish");
    int hidden = 0;
    for (const WorldSurface& surface : map.world->surfaces) {
        if (surface.type != BspSurfaceType::Patch) continue;
        EXPECT_FALSE(surface.drawn);
        EXPECT_EQ(surface.indexCount, 0u);
        EXPECT_EQ(surface.patch, -1);
        ++hidden;
    }
    EXPECT_EQ(hidden, 520);
}

TEST(Traps, T2NoVertexHoldsANumberThatIsNotFinite) {
    for (const char* name : {"am_spacecont", "am_thornish", "oacmpdm2"}) {
        LOAD_OR_SKIP(map, name);
        for (const Vertex& vertex : map.world->vertices) {
            for (int i = 0; i < 3; ++i) {
                ASSERT_TRUE(std::isfinite(vertex.position[i]) && std::isfinite(vertex.normal[i]));
            }
            for (int i = 0; i < 2; ++i) {
                ASSERT_TRUE(std::isfinite(vertex.st[i]) && std::isfinite(vertex.lightmapSt[i]));
            }
        }
    }
}

TEST(Traps, T3HugeTextureCoordinatesStayAsTheyAre) {
    LOAD_OR_SKIP(map, "oa_thor");
    float largest = 0;
    for (const Vertex& vertex : map.world->vertices) {
        largest = std::max({largest, std::abs(vertex.st.x), std::abs(vertex.st.y)});
    }
    EXPECT_GT(largest, 2e9f);
    EXPECT_LT(largest, 3e9f);
}

TEST(Traps, T4BoundsComeFromVertices) {
    LOAD_OR_SKIP(map, "oa_dm3");
    const BspModel& lump = map.world->bsp.models[0];
    const Bounds& bounds = map.world->bounds;
    EXPECT_TRUE(glm::any(glm::lessThan(bounds.mins, lump.mins - 1000.0f)));
    for (const WorldSurface& surface : map.world->surfaces) {
        if (!surface.drawn || surface.bspModel != 0) continue;
        for (uint32_t i = 0; i < surface.vertexCount; ++i) {
            const vec3& p = map.world->vertices[surface.firstVertex + i].position;
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(p, bounds.mins)) &&
                        glm::all(glm::lessThanEqual(p, bounds.maxs)));
        }
    }
}

TEST(Traps, T5ZeroAreaTrianglesStay) {
    LOAD_OR_SKIP(map, "oa_thor");
    int zero = 0;
    for (const WorldSurface& surface : map.world->surfaces) {
        if (surface.type == BspSurfaceType::Patch) continue;
        for (uint32_t i = 0; i < surface.indexCount; i += 3) {
            const auto corner = [&](uint32_t k) {
                return glm::dvec3(map.world->vertices[map.world->indices[surface.firstIndex + i + k]].position);
            };
            zero += glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))) < 1e-6;
        }
    }
    EXPECT_EQ(zero, 157);
}

TEST(Traps, T6MissingTexturesAreWarnedOfOnceAndShowTheDefault) {
    LOAD_OR_SKIP(map, "oa_spirit3");
    for (const char* name : {"dsi/cretebase", "c_redlines", "c_bluelines"}) {
        EXPECT_EQ(map.log.count(std::string(name) + "; the default look"), 1u) << name;
    }
    EXPECT_EQ(map.log.count("default drawn: textures/dsi/cretebase"), 1u);
    int faces = 0;
    for (const WorldSurface& surface : map.world->surfaces) {
        faces += surface.drawn && surface.material == 0;
    }
    EXPECT_GT(faces, 0);
}

TEST(Traps, T7VertexRemapKeysApplyOnlyWithVertexLight) {
    {
        LOAD_OR_SKIP(map, "islandctf");
        EXPECT_EQ(readWorldspawn(map.world->entities, false).remaps.size(), 0u);
        EXPECT_EQ(readWorldspawn(map.world->entities, true).remaps.size(), 15u);
        EXPECT_EQ(map.log.count("can't remap"), 0u);
    }
    WorldSettings settings;
    settings.vertexLight = true; // the keys name shaders that don't exist: warnings, no failure
    LOAD_OR_SKIP(map, "islandctf", settings);
    EXPECT_GT(map.log.count("METASHADER"), 0u);
}

TEST(Traps, T8ScriptsThatIgnoreTheirLightmapStillLoad) {
    LOAD_OR_SKIP(map, "oa_thor");
    int faces = 0;
    for (size_t i = 0; i < map.world->surfaces.size(); ++i) {
        const WorldSurface& surface = map.world->surfaces[i];
        if (!surface.drawn || map.world->bsp.surfaces[i].lightmap < 0) continue;
        const Material& material = map.libraries->materials.get(surface.material);
        if (material.lightmap >= 0) continue;
        EXPECT_TRUE(material.explicitScript);
        EXPECT_FALSE(material.isDefault);
        ++faces;
    }
    EXPECT_EQ(faces, 60);
}

} // namespace
} // namespace q3rt::test
