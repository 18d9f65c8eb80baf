// Points of a triangle by solid angle: the size of the angle, the distribution and the light against double precision,
// from slivers far away to triangles that fill the hemisphere.

#include <array>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "scene/direct_light.hpp"
#include "shader_text.hpp"

namespace q3rt {
namespace {

struct Corners {
    dvec3 a, b, c;
};

/// Van Oosterom and Strackee's formula; edges keep what a triple product of far corners would cancel.
double solidAngle(const Corners& t) {
    const double triple = std::abs(glm::dot(t.a, glm::cross(t.b - t.a, t.c - t.a)));
    const double a = glm::length(t.a), b = glm::length(t.b), c = glm::length(t.c);
    return 2 * std::atan2(triple, a * b * c + glm::dot(t.a, t.b) * c + glm::dot(t.b, t.c) * a + glm::dot(t.c, t.a) * b);
}

Corners cornersOf(const shader::SphericalTriangle& t) {
    const dvec3 a(t.corner);
    return {a, a + dvec3(t.edge1), a + dvec3(t.edge2)};
}

/// As the shaders see it from the origin: corner and edges are binary32 numbers.
shader::SphericalTriangle look(const vec3& corner, const vec3& edge1, const vec3& edge2) {
    const dvec3 cross = glm::cross(dvec3(edge1), dvec3(edge2));
    const double twice = glm::length(cross), height = std::abs(glm::dot(cross / twice, dvec3(corner)));
    return shader::makeSphericalTriangle(corner, edge1, edge2, static_cast<float>(height),
                                         static_cast<float>(twice / 2));
}

/// Triangles of all sizes at all distances, some almost in the plane of the eye.
shader::SphericalTriangle makeRandom(std::mt19937& generator) {
    std::normal_distribution<float> gauss;
    std::uniform_real_distribution<float> exponent(-3, 4);
    const auto vector = [&] { return vec3(gauss(generator), gauss(generator), gauss(generator)); };
    const float size = std::pow(10.0f, exponent(generator)), distance = std::pow(10.0f, exponent(generator));
    return look(vector() * distance, vector() * size, vector() * size);
}

TEST(SphericalTriangle, HasItsSolidAngleAtEverySize) {
    std::mt19937 generator(31);
    double worst = 0, worstOfBound = 0, smallest = 10, largest = 0;
    for (int i = 0; i < 200000; ++i) {
        const shader::SphericalTriangle t = makeRandom(generator);
        const double expected = solidAngle(cornersOf(t));
        smallest = std::min(smallest, expected);
        largest = std::max(largest, expected);
        const double error = std::abs(2 * double(t.halfAngle) / expected - 1);
        // Where the products of lengths cancel (the eye in a corner of the triangle's plane) their roundings count.
        const double product = double(t.lengths.x) * double(t.lengths.y) * double(t.lengths.z);
        const double left = double(t.triple) / std::abs(std::sin(expected / 2));
        worst = std::max(worst, error);
        worstOfBound = std::max(worstOfBound, error / (16 * double(kUnitRoundoff) * (1 + product / left)));
    }
    std::printf("solid angles from %.1e to %.6f sr, worst relative error %.1e, %.2f of its bound\n", smallest, largest,
                worst, worstOfBound);
    EXPECT_LT(smallest, 1e-12);
    EXPECT_GT(largest, 6.28);
    EXPECT_LT(worstOfBound, 1);
}

TEST(SphericalTriangle, IsNothingFromItsOwnCornerOrEdge) {
    EXPECT_EQ(look({0, 0, 0}, {10, 0, 0}, {0, 10, 0}).halfAngle, 0);
    EXPECT_EQ(look({50, 0, 0}, {10, 0, 0}, {0, 10, 0}).halfAngle, 0) << "in its plane, outside";
}

TEST(SphericalTriangle, PointsLieInTheTriangle) {
    std::mt19937 generator(32);
    std::uniform_real_distribution<float> unit(0.0f, 0.9999999f);
    for (int i = 0; i < 200000; ++i) {
        const shader::SphericalTriangle t = makeRandom(generator);
        const vec3 point = shader::sampleSphericalTriangle(t, unit(generator), unit(generator));
        ASSERT_TRUE(std::isfinite(point.x + point.y + point.z));
        // Weights of the corners by areas, in double.
        const dvec3 e1(t.edge1), e2(t.edge2), p = dvec3(point) - dvec3(t.corner), n = glm::cross(e1, e2);
        const double twice2 = glm::dot(n, n);
        const double w1 = glm::dot(glm::cross(p, e2), n) / twice2, w2 = glm::dot(glm::cross(e1, p), n) / twice2;
        // Rounding of the sum of corner and edges, over the triangle's least width.
        const double size = glm::length(dvec3(t.corner)) + glm::length(e1) + glm::length(e2);
        const double width = std::sqrt(twice2) / std::max({glm::length(e1), glm::length(e2), glm::length(e1 - e2)});
        const double slack = 8 * double(kUnitRoundoff) * size / width;
        ASSERT_GE(std::min({w1, w2, 1 - w1 - w2}), -slack) << i;
    }
}

/// Shares of the samples in 16 equal parts of the triangle (by area) against their shares of the solid angle.
double worstShare(const shader::SphericalTriangle& t, int strata) {
    constexpr int kSide = 4;
    std::array<double, 2 * kSide * kSide> got{}, expected{};
    const Corners corners = cornersOf(t);
    const dvec3 e1 = corners.b - corners.a, e2 = corners.c - corners.a;
    const auto at = [&](int i, int j) { return corners.a + e1 * (double(i) / kSide) + e2 * (double(j) / kSide); };
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; i + j < kSide; ++j) {
            const auto cell = static_cast<size_t>(2 * (i * kSide + j));
            expected[cell] = solidAngle({at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + j + 1 < kSide) expected[cell + 1] = solidAngle({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    const dvec3 n = glm::cross(e1, e2);
    for (int a = 0; a < strata; ++a)
        for (int b = 0; b < strata; ++b) {
            const vec3 point = shader::sampleSphericalTriangle(t, (static_cast<float>(a) + 0.5f) / float(strata),
                                                               (static_cast<float>(b) + 0.5f) / float(strata));
            const dvec3 p = dvec3(point) - corners.a;
            const double u = glm::clamp(kSide * glm::dot(glm::cross(p, e2), n) / glm::dot(n, n), 0.0, kSide - 1e-9);
            const double v = glm::clamp(kSide * glm::dot(glm::cross(e1, p), n) / glm::dot(n, n), 0.0, kSide - 1e-9);
            const auto cell = static_cast<size_t>(2 * (int(u) * kSide + int(v)));
            got[cell + (u - std::floor(u) + v - std::floor(v) > 1 ? 1 : 0)] += 1.0 / (strata * strata);
        }
    const double all = solidAngle(corners);
    double worst = 0;
    for (size_t cell = 0; cell < got.size(); ++cell)
        worst = std::max(worst, std::abs(got[cell] - expected[cell] / all));
    return worst;
}

TEST(SphericalTriangle, SamplesAreUniformBySolidAngle) {
    const struct {
        const char* name;
        vec3 corner, edge1, edge2;
    } cases[] = {
        {"ordinary", {30, -20, 60}, {40, 0, 10}, {0, 70, -20}},
        {"close and grazing", {-10, -10, 0.5f}, {400, 0, 0}, {0, 300, 0}},
        {"all around", {-500, -400, 0.01f}, {1500, 0, 0}, {0, 1400, 0}},
        {"far away", {3000, 2000, 900}, {0, 8, 0}, {0, 0, 8}},
        {"tiny and far away", {4000, 100, 3}, {0, 0.02f, 0}, {0, 0, 0.02f}},
        {"a sliver", {50, 20, 10}, {300, 1, 0}, {300, 0, 0.5f}},
        {"an edge overhead", {-170, 0, 0.1f}, {400, 0, 0}, {100, 300, 0}},
    };
    for (const auto& c : cases) {
        // A grid of n x n points tells a share to about 1 / n.
        const double worst = worstShare(look(c.corner, c.edge1, c.edge2), 512);
        EXPECT_LT(worst, 3e-3) << c.name;
    }
}

TEST(SphericalTriangle, GivesTheFormFactorWhateverTheDistance) {
    constexpr int kStrata = 256;
    std::mt19937 generator(33);
    std::normal_distribution<float> gauss;
    int checked = 0;
    for (const float distance : {0.01f, 1.0f, 30.0f, 1000.0f})
        for (int i = 0; i < 8; ++i, ++checked) {
            const vec3 a(gauss(generator) * 50 - 30, gauss(generator) * 50, distance);
            const vec3 e1(60 + gauss(generator) * 10, 5, gauss(generator) * 20), e2(5, 80, 10 + gauss(generator));
            TriangleLight light;
            light.corner[0] = a;
            light.corner[1] = a + e1;
            light.corner[2] = a + e2;
            ASSERT_TRUE(measureTriangle(light));
            const vec3 normal(0, 0, 1);
            double sum = 0;
            for (int u = 0; u < kStrata; ++u)
                for (int v = 0; v < kStrata; ++v)
                    sum += double(shader::sampleTriangleLight(vec3(0.0f), normal, a, light.corner[1] - a,
                                                              light.corner[2] - a, light.normal, light.areaQu2,
                                                              vec3(1.0f), true, (float(u) + 0.5f) / kStrata,
                                                              (float(v) + 0.5f) / kStrata)
                                      .irradiance.x);
            const double expected = std::numbers::pi * triangleFormFactor(vec3(0.0f), normal, light.corner);
            ASSERT_NEAR(sum / (kStrata * kStrata), expected, 2e-3 * expected + 1e-9) << "distance " << distance;
        }
    EXPECT_EQ(checked, 32);
}

} // namespace
} // namespace q3rt
