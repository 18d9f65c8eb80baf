// Damaged maps: loadWorld and what works on its result either refuse them in one line or survive them.

#include <cstdio>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "scene/entity_geometry.hpp"
#include "scene/light_rows.hpp"
#include "scene_fixture.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

/// Everything that a renderer does with a map at load and in a view.
void useWorld(const World& world, SceneLibraries& libraries, MemoryFiles& files) {
    const LightSet lights = extractLights(world, libraries.materials);
    buildLightRows(world, libraries.materials, describeRowLights(lights.triangles, lights.points));
    const vec3 centre = (world.bounds.mins + world.bounds.maxs) * 0.5f;
    world.grid.sample(centre);
    world.inPvs(centre, vec3(0));
    std::vector<vec3> points;
    std::vector<MarkFragment> fragments;
    MarkClipper().clip(world, libraries.materials, {{-16, -16, 8}, {-16, 16, 8}, {16, 16, 8}, {16, -16, 8}},
                       vec3(0, 0, -20), 384, points, 128, fragments, true);
    ModelLibrary models(files, libraries.materials);
    models.addInlineModels(world);
    FrameCommands frame;
    SceneView view;
    SceneEntity mover;
    mover.model = models.registerModel("*1");
    frame.entities.push_back(mover);
    view.entityCount = 1;
    ViewGeometry geometry;
    buildViewGeometry(frame, view, view.view, &world, models, libraries.materials, ViewGeometrySettings{}, geometry);
    for (const uint32_t index : geometry.indices) {
        ASSERT_LT(index, geometry.vertices.size());
    }
    for (const uint32_t index : world.indices) {
        ASSERT_LT(index, world.vertices.size());
    }
}

TEST(HostileMap, ChangedWordsAreRefusedOrSurvived) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    constexpr int kTries = 400;
    constexpr unsigned kSeed = 5;
    const LogCapture log;
    const auto original = *files->read("maps/fan.bsp");
    std::mt19937 random(kSeed);
    const uint32_t values[] = {0,          1,          0x7fffffff, 0x80000000, 0xffffffff,
                               0x7f800000, 0x7fc00000, 0x7f7fffff, 0xbf800000};
    int refused = 0;
    for (int i = 0; i < kTries; ++i) {
        MemoryFiles memory;
        memory.addText("scripts/a.shader", "textures/x { { map $whiteimage } }\n");
        auto& map = memory.files["maps/fan.bsp"];
        map = original;
        for (int change = 0; change <= i % 8; ++change) {
            // Half of the changes go to the small lumps at the start of the file, where the references are.
            const size_t limit = change % 2 ? map.size() : std::min<size_t>(map.size(), 65536);
            const size_t at = 8 + random() % (limit / 4 - 3) * 4;
            const uint32_t value = values[random() % std::size(values)];
            std::memcpy(map.data() + at, &value, sizeof value);
        }
        SceneLibraries libraries(memory);
        try {
            const auto world = loadWorld(memory, "maps/fan.bsp", libraries.materials, WorldSettings{});
            useWorld(*world, libraries, memory);
        } catch (const ContentError& error) {
            ++refused;
            EXPECT_NE(std::string(error.what()).find("maps/fan.bsp"), std::string::npos) << error.what();
        }
    }
    std::printf("%d damaged maps (seed %u): %d refused, the others loaded\n", kTries, kSeed, refused);
}

TEST(HostileMap, MissingMapNamesItself) {
    MemoryFiles memory;
    SceneLibraries libraries(memory);
    try {
        loadWorld(memory, "maps/none.bsp", libraries.materials, WorldSettings{});
        FAIL() << "no error";
    } catch (const ContentError& error) {
        EXPECT_NE(std::string(error.what()).find("maps/none.bsp"), std::string::npos);
    }
}

} // namespace
} // namespace q3rt::test
