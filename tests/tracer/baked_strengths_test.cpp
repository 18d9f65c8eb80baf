// Lights whose scripts changed after the bake get the strength back that the lightmap shows.

#include <cmath>

#include <gtest/gtest.h>

#include "renderer_rt/baked_strengths.hpp"
#include "tests/truth/test_game.hpp"

namespace q3rt {
namespace {

constexpr const char* kMap = "maps/room_square_light.bsp";

class BakedStrengths : public testing::Test {
  protected:
    float factorOf(const LightSet& lights, const std::string& name) {
        for (const BakedStrength& strength : estimateStrengths(*world, materials, textures, geometry, lights))
            if (strength.name == name) return strength.factor;
        return -1;
    }
    std::string nameOfEmitter() const {
        return materials.get(world->surfaces[static_cast<size_t>(asTheScriptSays.triangles.front().surface)].material)
            .name;
    }

    test::TestGame game;
    TextureLibrary textures{game, {}};
    MaterialLibrary materials{game, textures, {}};
    const std::unique_ptr<const World> world = loadWorld(game, kMap, materials, {});
    const ProbeGeometry geometry{*world, materials};
    LightSet asTheScriptSays = extractLights(*world, materials);
};

TEST_F(BakedStrengths, FollowsTheLightmap) {
    for (const float change : {0.25f, 1.0f, 4.0f}) {
        LightSet changed = asTheScriptSays;
        for (TriangleLight& light : changed.triangles)
            light.radiance *= change;
        // The script's own word counts a little.
        EXPECT_NEAR(factorOf(changed, nameOfEmitter()), 1 / change, 0.15f / change) << change;
    }
}

TEST_F(BakedStrengths, WhatTheBakeHadNotIsDark) {
    LightSet more = asTheScriptSays;
    more.points.push_back({.origin = 0.3f * world->bounds.mins + 0.7f * world->bounds.maxs, .intensity = vec3(1e6f)});
    const auto strengths = estimateStrengths(*world, materials, textures, geometry, more);
    applyStrengths(strengths, *world, materials, more);
    EXPECT_TRUE(more.points.empty());
    EXPECT_EQ(more.triangles.size(), asTheScriptSays.triangles.size());
    EXPECT_NEAR(factorOf(more, nameOfEmitter()), 1, 0.1f);
}

TEST_F(BakedStrengths, NothingToJudgeIsNothingToDo) {
    EXPECT_TRUE(estimateStrengths(*world, materials, textures, geometry, {}).empty());
    LightSet none;
    applyStrengths({{"textures/none", 0}}, *world, materials, none);
    EXPECT_TRUE(none.triangles.empty());
}

} // namespace
} // namespace q3rt
