// Strengths from light: exact where nothing is amiss, robust where something is.

#include <random>

#include <gtest/gtest.h>

#include "relight/light_fit.hpp"
#include "relight/light_score.hpp"
#include "relight/light_truth.hpp"

namespace q3rt {
namespace {

constexpr size_t kPatches = 400, kSources = 6;

struct Problem {
    std::vector<LightColumn> columns;
    std::vector<vec3> strengths;
    std::vector<FitTarget> targets;

    explicit Problem(unsigned seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> uniform(0, 1);
        targets.resize(kPatches);
        for (size_t s = 0; s < kSources; ++s) {
            LightColumn column;
            for (size_t i = 0; i < kPatches; ++i)
                if (uniform(random) < 0.4f) column.append(i, uniform(random));
            // The last source was dark.
            const vec3 strength =
                s + 1 == kSources ? vec3(0) : vec3(uniform(random), uniform(random), uniform(random)) * 100.0f;
            for (size_t k = 0; k < column.receiver.size(); ++k)
                targets[column.receiver[k]].light += column.value[k] * strength;
            columns.push_back(std::move(column));
            strengths.push_back(strength);
        }
        for (FitTarget& target : targets)
            target.weight = 0.5f + uniform(random);
    }

    void expectSolved(double tolerance) const {
        LightFit fit(targets);
        for (const LightColumn& column : columns)
            fit.add(column);
        fit.solve(8);
        for (size_t s = 0; s < kSources; ++s)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(fit.strength(s)[c], strengths[s][c], tolerance) << s;
    }
};

TEST(LightFit, FindsStrengths) { Problem(1).expectSolved(0.5); }

TEST(LightFit, IsNotMovedByAFewWrongPatches) {
    Problem problem(2);
    for (size_t i = 0; i < kPatches; i += 25) // decals, dirt: 4 % of the patches are dark
        problem.targets[i].light = vec3(0);
    problem.expectSolved(4);
}

TEST(LightFit, SaturatedPatchesAreLowerBounds) {
    Problem problem(3);
    size_t saturated = 0;
    for (FitTarget& target : problem.targets)
        if (target.light.x > 80 || target.light.y > 80 || target.light.z > 80) {
            target.light = glm::min(target.light, vec3(80));
            target.atLeast = true;
            ++saturated;
        }
    EXPECT_GT(saturated, kPatches / 10);
    EXPECT_LT(saturated, kPatches / 2);
    problem.expectSolved(1);
}

TEST(LightFit, BoundsThatContradictMeetInTheMiddle) {
    std::vector<FitTarget> targets(2);
    targets[0] = {.light = vec3(100), .weight = 1, .tolerance = 20, .atLeast = true};
    targets[1] = {.light = vec3(50), .weight = 1, .tolerance = 20, .atMost = true};
    LightColumn column;
    column.append(0, 1);
    column.append(1, 1);
    LightFit fit(targets);
    const size_t source = fit.add(column);
    fit.solve(3);
    EXPECT_NEAR(fit.strength(source).x, 75, 0.1);
}

TEST(LightFit, NeverBelowZeroNorAboveALimit) {
    std::vector<FitTarget> targets(2);
    targets[0].light = vec3(10, -5, 0);
    targets[0].weight = 1;
    LightColumn column;
    column.append(0, 1);
    LightFit fit(targets);
    const size_t source = fit.add(column);
    fit.solve(3);
    EXPECT_NEAR(fit.strength(source).x, 10, 1e-3);
    EXPECT_EQ(fit.strength(source).y, 0);
    fit.setLimit(source, 4);
    fit.solve(3);
    EXPECT_EQ(fit.strength(source).x, 4);
}

TEST(LightFit, ThePriceChoosesTheWeakerOfTwoThatExplainTheSame) {
    std::vector<FitTarget> targets(1);
    targets[0] = {vec3(50), 1};
    LightColumn near, far;
    near.append(0, 0.5f);
    far.append(0, 0.05f);
    LightFit fit(targets);
    const size_t weak = fit.add(near, 1e-3), strong = fit.add(far, 1e-3);
    fit.solve(6);
    EXPECT_GT(fit.strength(weak).x, 90);
    EXPECT_EQ(fit.strength(strong).x, 0);
}

TEST(LightScore, KnownNumbers) {
    ScoreSum sum;
    sum.add(10, 20, 1);
    sum.add(20, 40, 1);
    sum.add(33, 30, 1);
    const LightScore score = sum.result();
    EXPECT_NEAR(score.medianRelativeError, 0.5, 1e-9);
    EXPECT_NEAR(score.explainedShare, 60.0 / 90.0, 1e-9);
    EXPECT_NEAR(score.correlation, 0.4339, 1e-3);
}

TEST(LightTruth, CountsEnergyInBalls) {
    const std::string source =
        "// a comment\n{ \"classname\" \"worldspawn\"\n{ ( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) a/b 0 0 }\n"
        "{ patchDef2 { a/b ( 3 3 0 0 0 ) } } }\n"
        "{ \"classname\" \"light\" \"origin\" \"0 0 0\" \"light\" \"100\" }\n"
        "{ \"classname\" \"light\" \"origin\" \"10 0 0\" \"light\" \"100\" }\n"
        "{ \"classname\" \"light\" \"origin\" \"500 0 0\" \"light\" \"300\" }\n";
    const std::vector<PointLight> truth = parseMapSourceLights(source);
    ASSERT_EQ(truth.size(), 3u);
    // One light stands for the first two; the third is missing; one is where none was.
    const std::vector<PointLight> found = {{vec3(5, 5, 0), vec3(7500 * 180)}, {vec3(900, 0, 0), vec3(7500 * 60)}};
    const TruthReport report = compareWithTruth(truth, found);
    EXPECT_NEAR(report.sourceEnergy, 500, 1e-3);
    EXPECT_NEAR(report.foundEnergy, 240, 1e-3);
    EXPECT_NEAR(report.matchedShare, 200.0 / 500.0, 1e-6);
    EXPECT_NEAR(report.nearShare, 180.0 / 240.0, 1e-6);
}

} // namespace
} // namespace q3rt
