// The pure functions of accumulation, exposure and output, as C++.

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "shader_text.hpp"

namespace q3rt {
namespace {

TEST(Sums, LoseNothingOverAMillionTerms) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    vec3 sum(0.0f), low(0.0f), plain(0.0f);
    glm::dvec3 exact(0.0);
    for (int i = 0; i < 1 << 20; ++i) {
        const vec3 value(uniform(generator), 1.0f / 3, uniform(generator) < 0.001f ? 1000.0f : 1e-3f);
        shader::addCompensated(sum, low, value);
        plain += value;
        exact += glm::dvec3(value);
    }
    for (int k = 0; k < 3; ++k) {
        const double u = std::ldexp(1.0, -24);
        EXPECT_LT(std::abs(double(sum[k]) - double(low[k]) - exact[k]) / exact[k], 2 * u) << k;
        EXPECT_GT(std::abs(double(plain[k]) - exact[k]) / exact[k], 20 * u) << k << ": plain sums would do";
    }
}

TEST(Sums, SpreadIsThatOfAllValues) {
    std::mt19937 generator(4);
    std::normal_distribution<float> normal(100.0f, 0.5f);
    float mean = 0, squares = 0;
    double sum = 0, sum2 = 0;
    constexpr int kCount = 10000;
    for (int i = 1; i <= kCount; ++i) {
        const float value = normal(generator);
        shader::addToSpread(mean, squares, value, static_cast<float>(i));
        sum += value - 100.0;
        sum2 += std::pow(value - 100.0, 2);
    }
    EXPECT_NEAR(mean, 100 + sum / kCount, 1e-3);
    EXPECT_NEAR(squares / kCount, sum2 / kCount - std::pow(sum / kCount, 2), 1e-3);
}

TEST(Color, SrgbComesBackAndMatchesTheStandard) {
    for (int i = 0; i <= 255; ++i) {
        const float value = static_cast<float>(i) / 255;
        EXPECT_NEAR(shader::srgbFromLinear(shader::linearFromSrgb(value)), value, 1e-6);
    }
    EXPECT_NEAR(shader::linearFromSrgb(0.5f), 0.21404114, 1e-6);
    EXPECT_NEAR(shader::srgbFromLinear(0.18f), 0.46135613, 1e-6);
    EXPECT_NEAR(shader::linearFromSrgb(0.04045f), 0.0031308, 1e-6) << "both pieces meet";
}

TEST(Tonemap, ClampKeepsHue) {
    EXPECT_EQ(shader::clampKeepingHue(vec3(0.5f, 0.25f, 1.0f)), vec3(0.5f, 0.25f, 1.0f));
    EXPECT_EQ(shader::clampKeepingHue(vec3(2.0f, 1.0f, 0.5f)), vec3(1.0f, 0.5f, 0.25f));
}

TEST(Tonemap, CurvesRiseToWhiteAndKeepHue) {
    constexpr float kWhite = 4;
    for (const uint32_t curve : {kCurveFilmic, kCurveReinhard}) {
        EXPECT_EQ(shader::applyCurve(vec3(0), curve, kWhite), vec3(0));
        float before = 0;
        for (int i = 1; i <= 100; ++i) {
            const float x = kWhite * static_cast<float>(i) / 100;
            const vec3 shown = shader::applyCurve(vec3(x, x / 2, x / 4), curve, kWhite);
            EXPECT_GT(shown.x, before) << "curve " << curve << " at " << x;
            EXPECT_NEAR(shown.y, shown.x / 2, 1e-6);
            EXPECT_NEAR(shown.z, shown.x / 4, 1e-6);
            before = shown.x;
        }
        EXPECT_NEAR(before, 1, 1e-5);
        // Highlights roll off.
        const auto shownOf = [&](float x) { return shader::applyCurve(vec3(x), curve, kWhite).x; };
        EXPECT_LT(shownOf(4) - shownOf(3), 0.7 * (shownOf(2) - shownOf(1)));
    }
    EXPECT_EQ(shader::applyCurve(vec3(2, 1, 0.5f), kCurveClamp, kWhite), vec3(1, 1, 0.5f));
    EXPECT_NEAR(shader::displayColor(vec3(0.18f), kCurveClamp, kWhite, true).x, 0.46135613, 1e-6);
}

uint32_t binOf(float luminance) {
    const float place = (std::log2(luminance) - kDarkestLog2) / (kBrightestLog2 - kDarkestLog2);
    return static_cast<uint32_t>(place * kExposureBinCount);
}

TEST(Exposure, BringsTheMiddleToTheKey) {
    uint32_t bins[kExposureBinCount] = {};
    EXPECT_EQ(shader::wantedStops(bins, 0.7f), 0.7f) << "a black picture changes nothing";
    bins[binOf(0.05f)] = 900;
    bins[binOf(30.0f)] = 30; // a lamp
    const float width = (kBrightestLog2 - kDarkestLog2) / kExposureBinCount;
    EXPECT_NEAR(shader::wantedStops(bins, 0), std::log2(kExposureKey / 0.05f), width) << "lamps are left out";
    uint32_t dark[kExposureBinCount] = {1};
    EXPECT_EQ(shader::wantedStops(dark, 0), kExposureRangeStops);
}

TEST(Exposure, HasABoundedSpeed) {
    EXPECT_EQ(shader::adaptStops(0, 2, 0.25f), 0.25f);
    EXPECT_EQ(shader::adaptStops(0, -2, 0.25f), -0.25f);
    EXPECT_FLOAT_EQ(shader::adaptStops(1.9f, 2, 0.25f), 2);
}

TEST(Report, NoiseMakesAPictureLessLikeTheTruth) {
    EXPECT_EQ(shader::expectedLikeness(0.1f, 0), 1);
    EXPECT_EQ(shader::expectedLikeness(0, 0), 1);
    EXPECT_NEAR(shader::expectedLikeness(0.02f, 0.02f), 0.0009 / 0.0209, 1e-6) << "nothing but noise";
    EXPECT_NEAR(shader::expectedLikeness(0.021f, 0.001f), 0.0409 / 0.0419, 1e-6);
}

} // namespace
} // namespace q3rt
