// The pure functions of the denoiser and of temporal anti-aliasing, as C++.

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "shader_text.hpp"

namespace q3rt {
namespace {

constexpr int kCases = 20000;

class Random {
  public:
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(m_generator); }
    vec3 inBox(float size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
    vec3 direction() {
        vec3 v;
        do
            v = inBox(1);
        while (glm::dot(v, v) > 1 || glm::dot(v, v) < 1e-3f);
        return glm::normalize(v);
    }

  private:
    std::mt19937 m_generator{5};
};

TEST(Projection, IsTheInverseOfCameraDirection) {
    Random random;
    for (int i = 0; i < kCases; ++i) {
        const vec3 forwardUnit = random.direction();
        const vec3 leftUnit = glm::normalize(glm::cross(random.direction(), forwardUnit));
        const vec3 left = leftUnit * random.between(0.2f, 2.0f);
        const vec3 up = glm::cross(forwardUnit, leftUnit) * random.between(0.2f, 2.0f);
        const vec3 forward = forwardUnit + left * random.between(-0.5f, 0.5f) + up * random.between(-0.5f, 0.5f);
        const vec3 eye = random.inBox(4096);
        const vec2 place(random.between(0, 1), random.between(0, 1));
        const float distance = random.between(8, 4096);
        const vec3 point = eye + shader::cameraDirection(forward, left, up, place) * distance;
        const vec3 back = shader::projectPoint(eye, forward, left, up, forwardUnit, point);
        // Rounding of the point (|eye| u) at that distance, over the picture's width there.
        const float bound = 16 * kUnitRoundoff * (8192 + distance) / distance / 0.2f + 1e-5f;
        ASSERT_NEAR(back.x, place.x, bound) << i;
        ASSERT_NEAR(back.y, place.y, bound) << i;
        ASSERT_GT(back.z, 0);
    }
}

TEST(PackedNormal, ComesBackWithin16Bits) {
    Random random;
    float worst = 0;
    for (int i = 0; i < kCases; ++i) {
        const vec3 n = random.direction();
        const uint32_t bits = shader::packNormal(n);
        ASSERT_NE(bits, shader::kNoNormal);
        worst = std::max(worst, glm::distance(n, shader::unpackNormal(bits)));
    }
    // Half a step of 1/32767 in each octahedral coordinate, stretched at most 3 times on the sphere.
    EXPECT_LT(worst, 3 * std::sqrt(2.0f) * 0.5f / 32767);
    for (const vec3& axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(-1, 0, 0), vec3(0, -1, 0)})
        EXPECT_EQ(shader::unpackNormal(shader::packNormal(axis)), axis);
    EXPECT_LT(glm::distance(shader::unpackNormal(shader::packNormal({0, 0, -1})), vec3(0, 0, -1)), 1e-6f);
}

TEST(Winner, KeepsItsParts) {
    for (uint32_t stratum : {0u, 1u, 12345u, 0xffffffu})
        for (uint32_t from = 0; from < 9; ++from)
            for (uint32_t to = 0; to < 9; ++to) {
                const uint32_t winner = shader::packWinner(stratum, from, to);
                EXPECT_EQ(shader::winnerStratum(winner), stratum);
                EXPECT_EQ(shader::winnerFromPixel(winner), from);
                EXPECT_EQ(shader::winnerToPixel(winner), to);
            }
}

TEST(SameSurface, LooksAtPlaneDistanceAndNormal) {
    const vec3 point(100, 20, 30), normal(0, 0, 1);
    const auto same = [&](const vec3& apart, const vec3& otherNormal) {
        return shader::isSameSurface(point, normal, point + apart, otherNormal, 0.5f, 1.0f);
    };
    EXPECT_TRUE(same({0, 0, 0}, normal));
    EXPECT_TRUE(same({1, 1, 0.25f}, normal));
    EXPECT_FALSE(same({1, 1, 0.75f}, normal)) << "more than a pixel off the plane";
    EXPECT_FALSE(same({3, 0, 0}, normal)) << "more than four pixels away";
    EXPECT_TRUE(same({0, 0, 0}, glm::normalize(vec3(0.3f, 0, 1))));
    EXPECT_FALSE(same({0, 0, 0}, glm::normalize(vec3(0.6f, 0, 1))));
    EXPECT_FALSE(same({0, 0, 0}, -normal));
}

TEST(Weights, AreOneAtHomeAndFall) {
    EXPECT_EQ(shader::planeWeight(0, 2), 1);
    EXPECT_FLOAT_EQ(shader::planeWeight(-2, 2), std::exp(-1.0f));
    EXPECT_EQ(shader::normalWeight(1), 1);
    EXPECT_EQ(shader::normalWeight(-0.5f), 0);
    EXPECT_NEAR(shader::normalWeight(0.99f), std::pow(0.99, 128), 1e-5);
    EXPECT_EQ(shader::tapWeight(0, 2, 0, 0), 1);
    EXPECT_LT(shader::tapWeight(0, 2, 0.1f, 0), 1e-30f) << "without variance nothing is mixed";
    EXPECT_NEAR(shader::tapWeight(0, 2, -2, 0.25f), std::exp(-1.0), 1e-3);
    EXPECT_NEAR(shader::tapWeight(-0.5f, 2, 2, 0.25f), std::exp(-2.0), 1e-3);
    float tent = 0;
    for (int i = -1; i <= 1; ++i)
        tent += shader::tentKernel(i);
    EXPECT_EQ(tent, 1);
}

TEST(Blend, IsAMeanUntilSomethingChanges) {
    for (int n = 0; n < 64; ++n)
        EXPECT_FLOAT_EQ(shader::blendFactor(static_cast<float>(n), 0), 1.0f / static_cast<float>(n + 1));
    EXPECT_EQ(shader::blendFactor(40, 1), 1);
    EXPECT_EQ(shader::historyLoss({0, 3, 0}), 0);
    EXPECT_EQ(shader::historyLoss({0, 0, 0}), 0) << "no sample says nothing";
    EXPECT_EQ(shader::historyLoss({-1, 1, 0}), 1) << "a light that went out";
    EXPECT_EQ(shader::historyLoss({1, 10, 0}), 1);
    EXPECT_NEAR(shader::historyLoss({0.1f, 10, 0}), std::pow(0.1, 2.0 / 3.0), 1e-6);
    EXPECT_EQ(shader::historyLoss({1, 1, 1}), 0) << "one sample that has moved proves nothing";
    EXPECT_NEAR(shader::historyLoss({0.2f, 10, 0.01f}), std::pow(0.1, 2.0 / 3.0), 1e-6);
    EXPECT_EQ(shader::varianceOfMean({0.5f, 0.25f}, 8), 0);
    EXPECT_FLOAT_EQ(shader::varianceOfMean({0.5f, 0.5f}, 5), 0.0625f);
}

TEST(ColorSpace, YCoCgComesBack) {
    Random random;
    for (int i = 0; i < kCases; ++i) {
        const vec3 c(random.between(0, 8), random.between(0, 8), random.between(0, 8));
        const vec3 back = shader::rgbFromYCoCg(shader::yCoCgFromRgb(c));
        for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(back[k], c[k], 4e-6f);
    }
}

TEST(VarianceClipping, MovesTowardTheMeanOnlyAsFarAsNeeded) {
    Random random;
    int clipped = 0;
    for (int i = 0; i < kCases; ++i) {
        const vec3 mean = random.inBox(1), color = random.inBox(2), extent = glm::abs(random.inBox(1));
        const vec3 result = shader::clipToBox(color, mean, extent);
        const vec3 apart = glm::abs(color - mean);
        const bool inside = glm::all(glm::lessThanEqual(apart, extent));
        clipped += inside ? 0 : 1;
        for (int k = 0; k < 3; ++k)
            ASSERT_LE(std::abs(result[k] - mean[k]), extent[k] + 1e-6f);
        if (inside) {
            ASSERT_LT(glm::distance(result, color), 1e-6f);
        }
        // On the line from the mean to the colour.
        ASSERT_LT(glm::length(glm::cross(result - mean, color - mean)), 1e-5f);
    }
    EXPECT_GT(clipped, kCases / 10);
    EXPECT_EQ(shader::clipToBox({1, 2, 3}, {1, 2, 3}, vec3(0)), vec3(1, 2, 3));
}

TEST(CatmullRom, SumsToOneAndKeepsStraightLines) {
    for (int i = 0; i < 100; ++i) {
        const float t = static_cast<float>(i) / 100;
        const vec4 w = shader::catmullRom(t);
        EXPECT_NEAR(w.x + w.y + w.z + w.w, 1, 1e-6);
        EXPECT_NEAR(-w.x + w.z + 2 * w.w, t, 1e-6);
    }
    EXPECT_EQ(shader::catmullRom(0), vec4(0, 1, 0, 0));
}

} // namespace
} // namespace q3rt
