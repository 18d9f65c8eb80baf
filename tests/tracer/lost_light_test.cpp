// lights/MAP.ent in the renderer: in place of what scripts say, at once when it is reloaded, and left out when it is
// damaged.

#include <cstring>
#include <gtest/gtest.h>

#include "base/log.hpp"
#include "renderer_rt/grid_fit.hpp"
#include "renderer_rt/grid_light.hpp"
#include "scene/lost_light_file.hpp"
#include "tests/truth/test_game.hpp"
#include "trace_harness.hpp"

namespace q3rt {
namespace {

using test::TestGame;
using test::TraceHarness;

constexpr const char* kFile = "lights/room_square_light.ent";
constexpr const char* kMap = "maps/room_square_light.bsp";
constexpr int kSize = 12, kFrames = 4;
/// Straight down at the middle of the floor, so near that it is one point: 4 qu wide.
const test::Camera kDown{.eye = {0, 0, 20}, .pitch = 90, .fovX = 12};
const dvec3 kSeen(0, 0, 0), kUp(0, 0, 1);

/// The emitter is dark, and a point light of this value hangs above the floor.
constexpr double kHeight = 200;
std::string lightText(int value) {
    return "{ \"classname\" \"worldspawn\" \"q3map_surfacelight textures/baseq3test/light_square\" \"0 1 1 1\" }\n"
           "{ \"classname\" \"light\" \"origin\" \"0 0 200\" \"light\" \"" +
           std::to_string(value) + "\" }\n";
}
double radianceOfPoint(int value) { return kTestWallAlbedo * 7500 * value / (kHeight * kHeight) / 63.75; }
double radianceOfEmitter() { return kTestWallAlbedo * squareLightRoom::computeIrradiance(kSeen, kUp) / 63.75; }

double meanOf(const FloatImage& image) {
    double sum = 0;
    for (const float value : image.rgb)
        sum += value;
    return sum / static_cast<double>(image.rgb.size());
}

class LostLightTest : public testing::Test {
  protected:
    TestGame m_game;
    std::unique_ptr<TraceHarness> m_harness;

    void start(const char* lostLights) {
        m_harness = std::make_unique<TraceHarness>(m_game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kSize, kSize);
        for (const auto& [name, value] : {std::pair("rt_backend", "compute"),
                                          {"rt_accumulate", "1"},
                                          {"rt_ambient", "0"},
                                          {"rt_numRandomDL", "0"},
                                          {"rt_lostLights", lostLights}})
            m_harness->set(name, value);
        m_harness->loadMap(kMap);
    }
    double radiance(int frames = kFrames, const test::Camera& camera = kDown) {
        return meanOf(m_harness->radiance(camera, frames));
    }
};

TEST_F(LostLightTest, StandsInForWhatScriptsSay) {
    m_game.addText(kFile, lightText(100));
    start("1");
    EXPECT_NEAR(radiance(), radianceOfPoint(100), 0.01 * radianceOfPoint(100));
}

TEST_F(LostLightTest, WhatIsTooFaintIsLeftOut) {
    const auto file = [](const char* faintest) { // the floor gets 18.75
        return "{ \"classname\" \"worldspawn\" \"_faintest\" \"" + std::string(faintest) + "\" }\n" + lightText(100);
    };
    m_game.addText(kFile, file("18.5"));
    start("1");
    EXPECT_NEAR(radiance(), radianceOfPoint(100), 0.01 * radianceOfPoint(100));
    m_game.addText(kFile, file("19"));
    ASSERT_TRUE(m_harness->engine().runCommand({"rt_reloadLights"}));
    EXPECT_EQ(radiance(), 0);
}

TEST_F(LostLightTest, SurfacesThatAreTooFaintFarOffAreLeftOutThere) {
    const auto file = [](const char* faintest) {
        return "{ \"classname\" \"worldspawn\" \"_faintestSurface\" \"" + std::string(faintest) + "\" }\n";
    };
    const test::Camera corner{.eye = {250, 250, 20}, .pitch = 90, .fovX = 12};
    const double given = kTestWallAlbedo * squareLightRoom::computeIrradiance({250, 250, 0}, kUp) / 63.75;
    constexpr int kMoreFrames = 64;   // of an emitter's noise
    m_game.addText(kFile, file("2")); // each of the two triangles gives 3.5
    start("1");
    EXPECT_NEAR(radiance(kMoreFrames, corner), given, 0.02 * given);
    m_game.addText(kFile, file("4"));
    ASSERT_TRUE(m_harness->engine().runCommand({"rt_reloadLights"}));
    EXPECT_EQ(radiance(kFrames, corner), 0);
    EXPECT_NEAR(radiance(kMoreFrames), radianceOfEmitter(), 0.03 * radianceOfEmitter()) << "near it, always";
}

TEST_F(LostLightTest, IsReloadedAtOnce) {
    m_game.addText(kFile, lightText(100));
    start("1");
    radiance();
    m_game.addText(kFile, lightText(250));
    ASSERT_TRUE(m_harness->engine().runCommand({"rt_reloadLights"}));
    EXPECT_NEAR(radiance(), radianceOfPoint(250), 0.01 * radianceOfPoint(250));
}

TEST_F(LostLightTest, IsSwitchedOffAndOn) {
    m_game.addText(kFile, lightText(100));
    start("0");
    constexpr int kMoreFrames = 64; // of an emitter's noise
    EXPECT_NEAR(radiance(kMoreFrames), radianceOfEmitter(), 0.03 * radianceOfEmitter());
    m_harness->engine().cvars.set("rt_lostLights", "1");
    EXPECT_NEAR(radiance(), radianceOfPoint(100), 0.01 * radianceOfPoint(100));
}

TEST_F(LostLightTest, WhatNoLightExplainsComesFromTheGridOnce) {
    m_game.addText(kFile, lightText(0)); // the emitter is dark, but was there when the map was baked
    start("1");
    m_harness->set("rt_ambient", "1");
    EXPECT_NEAR(radiance(), radianceOfEmitter(), 0.03 * radianceOfEmitter());
    m_harness->engine().cvars.set("rt_lostLights", "0");
    constexpr int kMoreFrames = 64; // of an emitter's noise
    EXPECT_NEAR(radiance(kMoreFrames), radianceOfEmitter(), 0.01 * radianceOfEmitter()) << "the grid adds nothing";
}

/// The emitter is dark, whatever the lightmap has of it.
std::string darkWith(const char* key, int value) {
    return "{ \"classname\" \"worldspawn\" \"q3map_surfacelight textures/baseq3test/light_square\" \"0 1 1 1\" \"" +
           std::string(key) + "\" \"" + std::to_string(value) + "\" }\n";
}
double radianceOf(double irradiance) { return kTestWallAlbedo * irradiance / 63.75; }

TEST_F(LostLightTest, LightThatIsEverywhereArrives) {
    const double baked = squareLightRoom::computeIrradiance(kSeen, kUp);
    m_game.addText(kFile, darkWith("ambient", 2 * int(baked)));
    start("1");
    m_harness->set("rt_ambient", "1");
    EXPECT_NEAR(radiance(), radianceOf(2 * int(baked)), 0.01 * radianceOf(baked)) << "more than the lightmap has";
    m_game.addText(kFile, darkWith("ambient", int(baked) / 2));
    ASSERT_TRUE(m_harness->engine().runCommand({"rt_reloadLights"}));
    EXPECT_NEAR(radiance(), radianceOf(baked), 0.03 * radianceOf(baked)) << "luxels lack the rest";
}

TEST_F(LostLightTest, TheFloorArrives) {
    const double baked = squareLightRoom::computeIrradiance(kSeen, kUp);
    m_game.addText(kFile, darkWith("_minlight", 3 * int(baked)));
    start("1");
    m_harness->set("rt_ambient", "1");
    EXPECT_NEAR(radiance(), radianceOf(3 * int(baked)), 0.03 * radianceOf(baked));
    m_game.addText(kFile, darkWith("_minlight", 1));
    ASSERT_TRUE(m_harness->engine().runCommand({"rt_reloadLights"}));
    EXPECT_NEAR(radiance(), radianceOf(baked), 0.03 * radianceOf(baked)) << "it is light enough";
}

constexpr size_t kGridLump = 8 + 8 * 15; // of the header: offset and length

TEST_F(LostLightTest, WhatTheGridLacksLuxelsTell) {
    std::vector<std::byte> map = *m_game.read(kMap);
    int32_t grid[2];
    std::memcpy(grid, &map[kGridLump], sizeof grid);
    std::fill_n(map.begin() + grid[0], grid[1], std::byte{0});
    m_game.add(kMap, map);
    m_game.addText(kFile, lightText(0));
    start("1");
    m_harness->set("rt_ambient", "1");
    EXPECT_NEAR(radiance(), radianceOfEmitter(), 0.03 * radianceOfEmitter());
}

TEST_F(LostLightTest, LuxelsTellOfAMapWithoutAGrid) {
    std::vector<std::byte> map = *m_game.read(kMap);
    const int32_t none[2] = {};
    std::memcpy(&map[kGridLump], none, sizeof none);
    m_game.add(kMap, map);
    m_game.addText(kFile, lightText(0));
    start("1");
    m_harness->set("rt_ambient", "1");
    EXPECT_NEAR(radiance(), radianceOfEmitter(), 0.1 * radianceOfEmitter()) << "cells of 64 units";
}

TEST_F(LostLightTest, DamagedItIsLeftOut) {
    m_game.addText(kFile, lightText(100) + "{ \"classname\" \"light\" }");
    start("1");
    constexpr int kMoreFrames = 64;
    EXPECT_NEAR(radiance(kMoreFrames), radianceOfEmitter(), 0.03 * radianceOfEmitter());
}

TEST(LostLightFile, SaysWhatIsWrong) {
    TestGame game;
    TextureLibrary textures(game, {});
    MaterialLibrary materials(game, textures, {});
    const auto world = loadWorld(game, kMap, materials, {});
    EXPECT_EQ(mapName(*world), "room_square_light");
    std::string said;
    setLogSink([&](LogLevel, std::string_view line) { said = line; });
    EXPECT_FALSE(readLostLights(game, *world));
    EXPECT_NE(said.find("q3rt relight --map room_square_light"), std::string::npos) << said;
    game.addText(kFile, "{\n\"light\" }");
    EXPECT_FALSE(readLostLights(game, *world));
    EXPECT_NE(said.find(std::string(kFile) + ", line 2"), std::string::npos) << said;
    game.addText(kFile, "{ \"classname\" \"worldspawn\" \"_lightmap\" \"0123\" }");
    EXPECT_FALSE(readLostLights(game, *world));
    EXPECT_NE(said.find("another bake"), std::string::npos) << said;
    said.clear();
    game.addText(kFile, "{ \"classname\" \"worldspawn\" \"_lightmap\" \"" + lightmapFingerprint(world->bsp) + "\" }");
    EXPECT_TRUE(readLostLights(game, *world));
    EXPECT_EQ(said, "");
    setLogSink({});
}

TEST(LostLightFile, OfATwinServesARenamedMap) {
    TestGame game;
    TextureLibrary textures(game, {});
    MaterialLibrary materials(game, textures, {});
    const auto world = loadWorld(game, kMap, materials, {});
    const auto fileOf = [](const std::string& lightmap, int value) {
        return "{ \"classname\" \"worldspawn\" \"_lightmap\" \"" + lightmap + "\" \"ambient\" \"" +
               std::to_string(value) + "\" }";
    };
    const std::string hash = lightmapFingerprint(world->bsp);
    game.addText("lights/another.ent", fileOf(hash, 1));
    game.addText("lights/aaa.ent", "damaged " + hash);
    const auto ambientFor = [&](const std::string& map) -> float {
        const auto found = findLostLights(game, world->bsp, map);
        return found ? found->lights.ambientValue : 0;
    };
    EXPECT_EQ(ambientFor("room_square_light"), 1);
    game.addText("lights/room_square.ent", fileOf(hash, 2));
    EXPECT_EQ(ambientFor("room_square_light"), 2) << "the nearest name";
    game.addText(kFile, fileOf("0123", 3));
    EXPECT_EQ(ambientFor("room_square_light"), 2) << "its own is of another bake";
    game.addText(kFile, fileOf(hash, 4));
    EXPECT_EQ(ambientFor("room_square_light"), 4);

    Bsp unlit = world->bsp;
    unlit.lightmaps.clear();
    game.addText("lights/none.ent", fileOf(lightmapFingerprint(unlit), 5));
    EXPECT_FALSE(findLostLights(game, unlit, "unlit")) << "no lightmap is no likeness";
}

TEST(ModelLight, IsTheGridLessWhatTheLightsGive) {
    TestGame game;
    TextureLibrary textures(game, {});
    MaterialLibrary materials(game, textures, {});
    const auto world = loadWorld(game, kMap, materials, {});
    LightAnimation animation(materials, textures);
    const ModelLightScale scale{.ambient = 0.6f, .directed = 1};
    for (const LightSet& lights : {LightSet{}, extractLights(*world, materials)}) {
        LightTables tables = buildLightTables(*world, materials, lights, scale, animation);
        const std::vector<GridCell> baked = tables.grid;
        const ProbeGeometry geometry(*world, materials);
        const LightProbe probe(*world, geometry, tables);
        const std::vector<ProbeWays> given = explainGrid(probe, world->grid, tables.grid);
        std::vector<LuxelLack> nothing;
        for (const Vertex& vertex : world->vertices)
            nothing.push_back({.position = vertex.position, .normal = vertex.normal, .light = vec3(-1)});
        fitGrid(world->grid, tables.grid, nothing);
        int lit = 0;
        for (size_t i = 0; i < baked.size(); ++i) {
            if (!baked[i].models.valid) continue;
            const GridShare& left = tables.grid[i].models;
            const vec3 along = baked[i].models.ambient + baked[i].models.directed;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(left.ambient[c] + left.directed[c], std::max(0.0f, along[c] - given[i][0][c]), 1e-3f);
            if (lights.triangles.empty()) {
                EXPECT_EQ(left.ambient, scale.ambient * baked[i].surfaces.ambient);
            }
            EXPECT_EQ(tables.grid[i].surfaces.ambient, vec3(0));
            lit += along != vec3(0);
        }
        EXPECT_GT(lit, 10);
    }
}

TEST(RaiseGrid, GivesWhatLacks) {
    std::vector<GridCell> grid(3);
    grid[0].surfaces.valid = grid[1].surfaces.valid = true;
    grid[0].surfaces.ambient = vec3(4);
    grid[0].surfaces.directed = vec3(6);
    grid[1].surfaces.ambient = vec3(25);
    const ProbeWays half = {vec3(1), vec3(0), vec3(2), vec3(30), vec3(0), vec3(0)};
    std::vector<GridCell> raised = grid;
    raiseGrid(raised, {half, half, half}, vec3(0), vec3(20, 0, 20));
    // Given: 11, 4, 6, 34, 4, 4.
    EXPECT_NEAR(raised[0].surfaces.ambient.x, 4 + (9 + 16 + 14 + 0 + 16 + 16) / 6.0, 1e-5);
    EXPECT_EQ(raised[0].surfaces.ambient.y, 4);
    EXPECT_EQ(raised[0].surfaces.directed, grid[0].surfaces.directed);
    EXPECT_EQ(raised[1].surfaces.ambient, grid[1].surfaces.ambient) << "light enough";
    EXPECT_EQ(raised[2].surfaces.ambient, vec3(0)) << "in a wall";
    raised = grid;
    raiseGrid(raised, {half, half, half}, vec3(10, 3, 0), vec3(0));
    EXPECT_EQ(raised[0].surfaces.ambient, vec3(10, 4, 4)) << "light that is everywhere counts once";
    raised = grid;
    raised[0].isFitted = true;
    raiseGrid(raised, {half, half, half}, vec3(10, 3, 0), vec3(200));
    EXPECT_EQ(raised[0].surfaces.ambient, vec3(14, 7, 4)) << "its luxels did not count it, but counted the floor";
}

} // namespace
} // namespace q3rt
