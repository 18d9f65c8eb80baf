// The text of recovered lights: read back as it was written, damage named with its line, put in place of what scripts
// say.

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "scene/lost_lights.hpp"
#include "truth/test_game.hpp"

namespace q3rt {
namespace {

LostLights someLights() {
    LostLights lights;
    lights.lightmap = "0123456789abcdef";
    lights.compensate = 2.5f;
    lights.faintest = 1;
    lights.faintestSurface = 0.5f;
    lights.bounce = 0.5f;
    lights.ambientValue = 7;
    lights.ambientColor = {1, 0.5f, 0.25f};
    lights.floor = vec3(12);
    lights.surfaceLights.push_back({"textures/a/lamp", 400, {1, 0.8f, 0.6f}});
    lights.skyLights.push_back({"textures/skies/x", 90, vec3(1)});
    lights.suns.push_back({glm::normalize(vec3(1, -2, 3)), vec3(80, 60, 40), 0.05f});
    lights.points.push_back({vec3(-10, 20, 3000), 7500.0f * vec3(300, 150, 30)});
    lights.points.push_back({vec3(1, 2, 3), vec3(7500), true, glm::normalize(vec3(0.3f, 0.1f, -1)), 0.8f});
    return lights;
}

TEST(LostLights, TextIsReadBack) {
    const LostLights lights = someLights();
    const LostLights read = parseLostLights(formatLostLights(lights, "m"), "lights/m.ent");
    EXPECT_EQ(read.lightmap, lights.lightmap);
    EXPECT_FLOAT_EQ(read.compensate, 2.5f);
    EXPECT_FLOAT_EQ(read.faintest, 1);
    EXPECT_FLOAT_EQ(read.faintestSurface, 0.5f);
    EXPECT_FLOAT_EQ(read.bounce, 0.5f);
    EXPECT_FLOAT_EQ(read.ambientValue, 7);
    EXPECT_EQ(read.ambientColor, lights.ambientColor);
    EXPECT_EQ(read.floor, lights.floor);
    EXPECT_EQ(read.stage, 0u);
    ASSERT_EQ(read.surfaceLights.size(), 1u);
    EXPECT_EQ(read.surfaceLights[0].material, "textures/a/lamp");
    EXPECT_FLOAT_EQ(read.surfaceLights[0].value, 400);
    ASSERT_EQ(read.skyLights.size(), 1u);
    ASSERT_EQ(read.suns.size(), 1u);
    // Angles have four digits, colours two, strengths three.
    EXPECT_NEAR(glm::length(read.suns[0].direction - lights.suns[0].direction), 0, 1e-3);
    EXPECT_NEAR(glm::length(read.suns[0].irradiance - lights.suns[0].irradiance), 0, 1);
    EXPECT_NEAR(read.suns[0].halfAngleRadians, 0.05f, 2e-3);
    ASSERT_EQ(read.points.size(), 2u);
    EXPECT_EQ(read.points[0].origin, lights.points[0].origin);
    EXPECT_NEAR(glm::length(read.points[0].intensity - lights.points[0].intensity), 0, 7500 * 3);
    EXPECT_FALSE(read.points[0].spot);
    EXPECT_TRUE(read.points[1].spot);
    EXPECT_NEAR(glm::length(read.points[1].direction - lights.points[1].direction), 0, 0.01);
    EXPECT_NEAR(read.points[1].cosOuter, 0.8f, 0.01);
}

TEST(LostLights, WrittenAgainItIsTheSameText) {
    const std::string once = formatLostLights(parseLostLights(formatLostLights(someLights(), "m"), "a"), "m");
    EXPECT_EQ(formatLostLights(parseLostLights(once, "a"), "m"), once);
}

TEST(LostLights, HalfDoneWorkIsMarked) {
    LostLights lights = someLights();
    lights.stage = 3;
    lights.budget = 64;
    const LostLights read = parseLostLights(formatLostLights(lights, "m"), "a");
    EXPECT_EQ(read.stage, 3u);
    EXPECT_EQ(read.budget, 64u);
}

TEST(LostLights, DamageIsNamedWithItsLine) {
    struct Case {
        const char *text, *line, *what;
    };
    const Case cases[] = {
        {"nonsense", "line 1", "'nonsense' stands where {"},
        {"{\n\"classname\" \"light\"\n\"origin\" \"1 2 x\"\n}", "line 3", "'x' is not a number"},
        {"{\n\"classname\" \"light\"\n\"origin\" \"1 2\"\n}", "line 3", "3 numbers"},
        {"{ \"classname\" \"light\" }", "line 1", "without an origin"},
        {"{ \"classname\" \"light\"\n\"Origin\" \"1 2 3e42\" }", "line 2", "'3e42' is not a number"},
        {"{\n\"a\" \"b\"\n", "line 3", "of line 1 does not end"},
        {"{\n\"light\" }", "line 2", "has no value"},
        {"{\n\n\"light\" \"nan\" }", "line 3", "'nan' is not a number"},
        {"{\n\"light\" \"1e30\" }", "line 2", "up to 1e9"},
        {"{\n\"_color\" \"1 -1 1\" }", "line 2", "below 0"},
        {"{\n\"_compensate\" \"0\" }", "line 2", "above 0"},
        {"{\n\"_minlight\" \"1 2\" }", "line 2", "one number, or three"},
        {"{\n\"q3map_surfacelight\" \"1 1 1 1\" }", "line 2", "no shader"},
        {"{\n\"q3map_sun\" \"1 1 1\" }", "line 2", "6 numbers"},
        {"{ }\n{ \"classname\" \"light\" \"origin\" \"0 0 0\"\n\"target\" \"t1\" }\n", "line 2", "targetname 't1'"},
    };
    for (const Case& c : cases) {
        try {
            parseLostLights(c.text, "lights/m.ent");
            ADD_FAILURE() << c.text;
        } catch (const ContentError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(std::string("lights/m.ent, ") + c.line), std::string::npos) << message;
            EXPECT_NE(message.find(c.what), std::string::npos) << message;
            EXPECT_NE(message.find("delete the file"), std::string::npos) << message;
        }
    }
}

TEST(LostLights, ReplaceWhatScriptsSay) {
    test::TestGame game;
    TextureLibrary textures(game, {});
    MaterialLibrary materials(game, textures, {});
    const auto world = loadWorld(game, "maps/corridor_three_clusters.bsp", materials, {});
    const LightSet scripted = extractLights(*world, materials);
    ASSERT_FALSE(scripted.triangles.empty());
    const std::string first =
        materials.get(world->surfaces[static_cast<size_t>(scripted.triangles[0].surface)].material).name;
    LostLights lost = someLights();
    lost.surfaceLights = {{first, 100, vec3(1, 0.5f, 0)}};
    LightSet lights = scripted;
    applyLostLights(lost, *world, materials, lights);
    ASSERT_EQ(lights.triangles.size(), scripted.triangles.size());
    size_t changed = 0;
    for (size_t i = 0; i < lights.triangles.size(); ++i) {
        const TriangleLight& light = lights.triangles[i];
        const bool isNamed = materials.get(world->surfaces[static_cast<size_t>(light.surface)].material).name == first;
        // What the file leaves out stays; all of it was darkened by the bake.
        const vec3 expected =
            isNamed ? vec3(1, 0.5f, 0) * static_cast<float>(0.75 * 100 / M_PI) : scripted.triangles[i].radiance;
        EXPECT_NEAR(light.faintest, 0.5 / 2.5, 1e-5);
        EXPECT_NEAR(glm::length(light.radiance - expected / 2.5f), 0, 1e-4 * double(glm::length(expected)));
        changed += isNamed ? 1 : 0;
    }
    EXPECT_GT(changed, 0u);
    EXPECT_LT(changed, lights.triangles.size());
    EXPECT_NEAR(lights.ambient.y, 0.5 * 7 / 2.5, 1e-5);
    EXPECT_NEAR(lights.floor.x, 12 / 2.5, 1e-5);
    ASSERT_EQ(lights.points.size(), 2u);
    EXPECT_NEAR(lights.points[0].intensity.x, 7500 * 300 / 2.5, 1);
    EXPECT_NEAR(lights.points[0].faintest, 1 / 2.5, 1e-5);
    ASSERT_EQ(lights.suns.size(), 1u);
    EXPECT_NEAR(lights.suns[0].irradiance.x, 80 / 2.5, 1e-3);
}

TEST(LostLights, TheFingerprintTellsBakesApart) {
    test::TestGame game;
    Bsp bsp = parseBsp(*game.read("maps/room_square_light.bsp"), "a");
    const std::string before = lightmapFingerprint(bsp);
    EXPECT_EQ(before.size(), 16u);
    bsp.lightmaps[5] ^= 1;
    EXPECT_NE(lightmapFingerprint(bsp), before);
}

} // namespace
} // namespace q3rt
