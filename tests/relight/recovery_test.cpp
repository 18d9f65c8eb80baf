// A map of our own is lit by lights that its data does not tell of, and relighting has to find them.

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "base/parallel.hpp"
#include "relight/light_truth.hpp"
#include "relight/lost_units.hpp"
#include "relight/relight.hpp"
#include "scene/direct_light.hpp"
#include "truth/test_game.hpp"

namespace q3rt {
namespace {

/// What the scripts say was a part of that when the map was baked.
constexpr float kScriptedShare = 0.3f;

class RelitCorridor : public testing::Test {
  protected:
    test::TestGame m_game;
    TextureLibrary m_textures{m_game, {}};
    MaterialLibrary m_materials{m_game, m_textures, {}};
    std::unique_ptr<World> m_world = loadWorld(m_game, "maps/corridor_three_clusters.bsp", m_materials, {});
    std::vector<PointLight> m_truth;

    void SetUp() override {
        m_truth.push_back({vec3(60, 200, 150), 7500.0f * vec3(100, 60, 30)});
        m_truth.push_back({vec3(480, 380, 100), 7500.0f * vec3(24, 48, 60)});
        m_truth.push_back({vec3(900, 300, 170), 7500.0f * vec3(120, 120, 120), true, vec3(0, 0, -1), 0.8f});
        for (PointLight& light : m_truth)
            light.faintest = kFaintestLight;
        bake();
    }

    void bake() {
        LightSet lights = extractLights(*m_world, m_materials);
        for (TriangleLight& light : lights.triangles)
            light.radiance *= kScriptedShare;
        lights.points = m_truth;
        const DirectLightTracer tracer(*m_world, m_materials, lights);
        const LuxelMap luxels = buildLuxelMap(*m_world, m_materials, {});
        std::fill(m_world->bsp.lightmaps.begin(), m_world->bsp.lightmaps.end(), uint8_t{0});
        parallelFor(luxels.luxels.size(), [&](size_t i) {
            const PlacedLuxel& luxel = luxels.luxels[i];
            std::mt19937 random(luxel.texel);
            const vec3 sum =
                tracer.at(luxel.position + kSampleOffsetQu * luxel.normal, luxel.normal, {16, 1}, random).total();
            const float largest = std::max({sum.x, sum.y, sum.z, 255.0f});
            for (int c = 0; c < 3; ++c)
                m_world->bsp.lightmaps[size_t{3} * luxel.texel + static_cast<size_t>(c)] =
                    static_cast<uint8_t>(sum[c] * 255 / largest + 0.5f);
        });
    }

    static RelightSettings smallSettings() {
        RelightSettings settings;
        settings.luxels.patchCount = 2048;
        settings.openPoints = 800;
        settings.budget = 16;
        return settings;
    }
};

TEST_F(RelitCorridor, LightsAreFound) {
    const RelightResult result = relight(*m_world, m_materials, smallSettings(), nullptr, {});
    EXPECT_GE(result.after.correlation, 0.98);
    EXPECT_LE(result.after.medianRelativeError, 0.1);
    EXPECT_GT(result.after.correlation, result.before.correlation);
    const TruthReport truth = compareWithTruth(m_truth, result.lights.points);
    EXPECT_GE(truth.matchedShare, 0.8);
    EXPECT_GE(truth.nearShare, 0.7);
    // Strengths of scripts as the bake had them.
    const LightSet scripted = extractLights(*m_world, m_materials);
    LightSet recovered = scripted;
    applyLostLights(result.lights, *m_world, m_materials, recovered);
    ASSERT_FALSE(scripted.triangles.empty());
    for (size_t i = 0; i < scripted.triangles.size(); ++i)
        EXPECT_NEAR(glm::length(recovered.triangles[i].radiance) / glm::length(scripted.triangles[i].radiance),
                    kScriptedShare, 0.1);
}

TEST_F(RelitCorridor, BrokenOffWorkEndsTheSame) {
    std::vector<LostLights> stages;
    RelightProgress progress;
    size_t last = 0;
    progress.step = [&](size_t done, size_t all) {
        EXPECT_GE(done, last);
        EXPECT_LE(done, all);
        last = done;
    };
    progress.stage = [&](const LostLights& lights) { stages.push_back(lights); };
    const RelightResult whole = relight(*m_world, m_materials, smallSettings(), nullptr, progress);
    ASSERT_GE(stages.size(), 2u);
    const RelightResult rest = relight(*m_world, m_materials, smallSettings(), &stages[1], {});
    EXPECT_EQ(formatLostLights(rest.lights, ""), formatLostLights(whole.lights, ""));
}

TEST_F(RelitCorridor, TheBudgetHolds) {
    RelightSettings settings = smallSettings();
    settings.budget = 2;
    EXPECT_LE(relight(*m_world, m_materials, settings, nullptr, {}).lights.points.size(), 2u);
    settings.budget = 0;
    EXPECT_EQ(relight(*m_world, m_materials, settings, nullptr, {}).lights.points.size(), 0u);
}

TEST_F(RelitCorridor, WithoutALightmapThereIsNothingToLearn) {
    m_world->bsp.lightmaps.clear();
    EXPECT_EQ(relight(*m_world, m_materials, smallSettings(), nullptr, {}).luxelCount, 0u);
}

} // namespace
} // namespace q3rt
