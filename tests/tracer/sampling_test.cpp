// Sampling functions against closed forms: means over stratified numbers, and what a light must give.

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "scene/lights.hpp"
#include "shader_text.hpp"

namespace q3rt {
namespace {

constexpr int kStrata = 512; ///< a side: 262,144 samples

/// Mean of f(u, v) over jittered strata of the unit square.
template <class Function>
auto meanOverSquare(Function&& f) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<float> jitter(0.0f, 0.999f);
    decltype(f(0.0f, 0.0f)) sum{};
    for (int i = 0; i < kStrata; ++i)
        for (int j = 0; j < kStrata; ++j)
            sum += f((static_cast<float>(i) + jitter(generator)) / kStrata,
                     (static_cast<float>(j) + jitter(generator)) / kStrata);
    return sum / static_cast<float>(kStrata * kStrata);
}

/// Irradiance at the origin (normal +z) under a w x h rectangle at height d whose corner is above the origin, radiance
/// 1: the corner-patch form factor times pi (Howell, catalog of configuration factors, B-3).
double cornerRectangle(double w, double h, double d) {
    const double x = w / d, y = h / d;
    return 0.5 * (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                  y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y)));
}

TEST(Constants, AreTheStandardLibrarys) {
    EXPECT_FLOAT_EQ(kPi, std::numbers::pi_v<float>);
    EXPECT_FLOAT_EQ(kTwoPi, 2 * std::numbers::pi_v<float>);
    const double u = std::ldexp(1.0, -24);
    EXPECT_EQ(kUnitRoundoff, static_cast<float>(u));
    const auto gamma = [u](int n) { return static_cast<float>(n * u / (1 - n * u)); };
    EXPECT_GE(kEdgeSumError, gamma(3));
    EXPECT_GE(kOwnTriangleError, gamma(8));
    EXPECT_GE(kHitPointError, gamma(8));
    EXPECT_GE(kTransformError, gamma(3));
    EXPECT_GE(kInverseError, gamma(6));
    EXPECT_GE(kMatrixInverseError, gamma(7));
    EXPECT_GE(kSameDistanceError, gamma(19));
    // 4000 / (255 d^2) of the light picture, d in sixteenths of the radius, at irradiance 63.75.
    EXPECT_NEAR(kDynamicLightIntensity, 63.75 * 4000 / (255.0 * 256), 1e-5);
}

TEST(Sampling, DiscAndCosineHemisphere) {
    const vec3 disc = meanOverSquare([](float u, float v) {
        const vec2 p = shader::sampleDisc(u, v);
        return vec3(p.x, p.y, dot(p, p));
    });
    EXPECT_NEAR(disc.x, 0, 1e-4);
    EXPECT_NEAR(disc.y, 0, 1e-4);
    EXPECT_NEAR(disc.z, 0.5, 1e-4);
    const vec3 normal = glm::normalize(vec3(0.3f, -0.8f, -0.5f));
    const vec2 cosines = meanOverSquare([&](float u, float v) {
        const float c = dot(shader::sampleCosine(normal, u, v), normal);
        return vec2(c, c * c);
    });
    EXPECT_NEAR(cosines.x, 2.0f / 3, 1e-4);
    EXPECT_NEAR(cosines.y, 0.5f, 1e-4);
}

TEST(Sampling, FramesAreOrthonormal) {
    std::mt19937 generator(11);
    std::normal_distribution<float> gauss;
    int checked = 0;
    for (int i = 0; i < 10000; ++i, ++checked) {
        const vec3 n = glm::normalize(vec3(gauss(generator), gauss(generator), gauss(generator)));
        const shader::Frame frame = shader::frameAround(n);
        ASSERT_NEAR(dot(frame.tangent, frame.bitangent), 0, 1e-5);
        ASSERT_NEAR(dot(frame.tangent, n), 0, 1e-5);
        ASSERT_NEAR(dot(glm::cross(frame.tangent, frame.bitangent), n), 1, 1e-5);
    }
    EXPECT_EQ(checked, 10000);
}

TEST(TriangleLight, GivesNothingWhereItIsFaintAndFar) {
    TriangleLight light;
    light.corner[0] = vec3(0, 0, 100), light.corner[1] = vec3(0, 9, 100), light.corner[2] = vec3(9, 0, 100);
    light.radiance = vec3(20, 400, 1);
    ASSERT_TRUE(measureTriangle(light));
    const auto isFaint = [&](const vec3& point, const vec3& normal) {
        const vec3 *c = light.corner, edge1 = c[1] - c[0], edge2 = c[2] - c[0];
        const bool result = shader::isTriangleFaint(point, normal, c[0], edge1, edge2, light.normal, light.areaQu2,
                                                    light.radiance, light.faintest);
        EXPECT_EQ(result, isTooFaint(light, point, normal)) << "the processor's answer";
        return result;
    };
    const vec3 below(3, 3, 0), up(0, 0, 1);
    const float given = 400 * light.areaQu2 / (100 * 100); // straight on
    for (const auto& [share, faint] : {std::pair(0.0f, false), {0.99f, false}, {1.01f, true}}) {
        light.faintest = share * given;
        EXPECT_EQ(isFaint(below, up), faint) << share;
        EXPECT_FALSE(isFaint(vec3(3, 3, 80), vec3(0.999f, 0, 0.04f))) << "grazing, but near";
    }
    light.faintest = 0.72f * given;
    EXPECT_TRUE(isFaint(below, glm::normalize(vec3(1, 0, 1)))) << "by the surface's cosine";
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-200, 200);
    int faint = 0;
    for (int i = 0; i < 2000; ++i)
        faint += isFaint(vec3(place(random), place(random), place(random)), up);
    EXPECT_GT(faint, 100);
    EXPECT_LT(faint, 2000);
}

TEST(TriangleLight, RectangleGivesItsFormFactor) {
    // Two triangles, 100 x 60 at height 80, a corner above the point; the lit side looks down.
    const float w = 100, h = 60, d = 80;
    const vec3 a(0, 0, d), b(w, 0, d), c(w, h, d), e(0, h, d);
    const vec3 down(0, 0, -1);
    const float area = 0.5f * w * h;
    const double expected = cornerRectangle(w, h, d);
    for (const auto sample : {shader::sampleTriangleLight, shader::sampleTriangleLightByArea}) {
        const vec3 got = meanOverSquare([&](float u, float v) {
            const vec3 point(0.0f), up(0, 0, 1);
            return sample(point, up, a, b - a, c - a, down, area, vec3(1.0f), false, u, v).irradiance +
                   sample(point, up, a, c - a, e - a, down, area, vec3(1.0f), false, u, v).irradiance;
        });
        EXPECT_NEAR(got.x / expected, 1, 1e-3);
    }
    // Seen from behind it gives nothing, unless it is two-sided.
    EXPECT_EQ(
        shader::sampleTriangleLight(vec3(0, 0, 200), down, a, b - a, c - a, down, area, vec3(1.0f), false, 0.2f, 0.2f)
            .irradiance,
        vec3(0.0f));
    EXPECT_GT(
        shader::sampleTriangleLight(vec3(0, 0, 200), down, a, b - a, c - a, down, area, vec3(1.0f), true, 0.2f, 0.2f)
            .irradiance.x,
        0.0f);
}

TEST(SphereLight, UnoccludedSphereGivesInverseSquare) {
    // A sphere wholly above the horizon: E = I cos / d^2, exactly.
    const vec3 center(30, 10, 50);
    const float d2 = dot(center, center);
    const vec3 got = meanOverSquare([&](float u, float v) {
        return shader::sampleSphereLight(vec3(0.0f), vec3(0, 0, 1), center, 16, vec3(1000.0f), u, v).irradiance;
    });
    EXPECT_NEAR(got.x, 1000 * 50 / std::sqrt(d2) / d2, 1e-4);
    // A point light is no brighter inside the compilers' closest distance.
    const auto near = shader::sampleSphereLight(vec3(0.0f), vec3(0, 0, 1), vec3(0, 0, 2), 0, vec3(256.0f), 0, 0);
    EXPECT_FLOAT_EQ(near.irradiance.x, 1.0f);
}

TEST(SphereLight, ShadowRayEndsOnTheSphere) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> unit(0.0f, 0.999f);
    const vec3 center(30, 10, 50);
    for (int i = 0; i < 1000; ++i) {
        const auto s = shader::sampleSphereLight(vec3(0.0f), vec3(0, 0, 1), center, 16, vec3(1.0f), unit(generator),
                                                 unit(generator));
        ASSERT_NEAR(glm::length(s.direction - center), 16, 0.02);
    }
}

TEST(Random, CountsAndMeansOfTheHash) {
    std::array<double, 4> sum{};
    std::array<std::array<int, 16>, 4> bins{};
    constexpr int kCount = 1 << 16;
    for (uint32_t i = 0; i < kCount; ++i) {
        const vec4 r = shader::randomNumbers(glm::uvec4(i & 255, i >> 8, 3, 0), 17);
        for (int k = 0; k < 4; ++k) {
            ASSERT_GE(r[k], 0.0f);
            ASSERT_LT(r[k], 1.0f);
            sum[static_cast<size_t>(k)] += r[k];
            ++bins[static_cast<size_t>(k)][static_cast<size_t>(r[k] * 16)];
        }
    }
    for (size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(sum[k] / kCount, 0.5, 5 * 0.2887 / 256);
        double chi2 = 0;
        for (const int count : bins[k])
            chi2 += std::pow(count - kCount / 16.0, 2) / (kCount / 16.0);
        EXPECT_LT(chi2, 50) << "15 degrees of freedom: 50 has probability 1e-5";
    }
}

} // namespace
} // namespace q3rt
