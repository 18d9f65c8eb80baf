#include "baseq3-test/form_factor.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace q3rt::test {

namespace {

constexpr double kPi = std::numbers::pi;

RectangleCorners makeRectangle(const dvec3& origin, const dvec3& u, const dvec3& v) {
    return {origin, origin + u, origin + u + v, origin + v};
}

/// Midpoint rule over count x count cells of cos cos / (pi d^2); both sides emit.
double integrateNumerically(const dvec3& point, const dvec3& normal, const RectangleCorners& corners, int count) {
    const dvec3 u = corners[1] - corners[0], v = corners[3] - corners[0];
    const dvec3 areaVector = glm::cross(u, v) / double(count * count);
    double sum = 0;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) {
            const dvec3 way = corners[0] + u * ((i + 0.5) / count) + v * ((j + 0.5) / count) - point;
            const double squared = glm::dot(way, way);
            sum +=
                std::max(0.0, glm::dot(normal, way)) * std::abs(glm::dot(areaVector, way)) / (kPi * squared * squared);
        }
    return sum;
}

} // namespace

TEST(FormFactor, ParallelRectangleAgreesWithTextbookFormula) {
    // Corner of an a x b rectangle straight above the element at height c, parallel to it (Howell's catalogue, B-3).
    int cases = 0;
    for (const double a : {0.1, 1.0, 7.0})
        for (const double b : {0.2, 3.0})
            for (const double c : {0.5, 2.0}) {
                const double x = a / c, y = b / c;
                const double expected = (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                                         y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
                                        (2 * kPi);
                EXPECT_NEAR(rectangleFormFactor({0, 0, 0}, {0, 0, 1}, makeRectangle({0, 0, c}, {a, 0, 0}, {0, b, 0})),
                            expected, 1e-14);
                ++cases;
            }
    EXPECT_EQ(cases, 12);
}

TEST(FormFactor, PerpendicularRectangleAgreesWithTextbookFormula) {
    // Rectangle b wide and a high that stands on the element's plane at distance c, one corner opposite (B-5).
    for (const double a : {0.3, 2.0})
        for (const double b : {0.4, 5.0}) {
            const double c = 1.5, x = a / c, y = b / c;
            const double expected =
                (std::atan(y) - std::atan(y / std::sqrt(1 + x * x)) / std::sqrt(1 + x * x)) / (2 * kPi);
            EXPECT_NEAR(rectangleFormFactor({0, 0, 0}, {0, 0, 1}, makeRectangle({c, 0, 0}, {0, b, 0}, {0, 0, a})),
                        expected, 1e-14);
        }
}

TEST(FormFactor, RandomRectanglesAgreeWithNumericIntegration) {
    std::mt19937_64 generator(5);
    const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53 * 2 - 1; };
    int cases = 0;
    while (cases < 200) {
        const dvec3 origin(uniform() * 3, uniform() * 3, uniform() * 3);
        const dvec3 u(uniform(), uniform(), uniform());
        const dvec3 v = glm::cross(u, dvec3(uniform(), uniform(), uniform()));
        const dvec3 normal = glm::normalize(dvec3(uniform(), uniform(), uniform()));
        // The midpoint rule converges only away from the singularity.
        if (glm::length(origin + 0.5 * (u + v)) < 2.0 * (glm::length(u) + glm::length(v))) continue;
        const RectangleCorners corners = makeRectangle(origin, u, v);
        const double expected = integrateNumerically({0, 0, 0}, normal, corners, 100);
        EXPECT_NEAR(rectangleFormFactor({0, 0, 0}, normal, corners), expected, 2e-4 * expected + 1e-6);
        ++cases;
    }
    EXPECT_EQ(cases, 200);
}

TEST(FormFactor, LimitsHold) {
    const RectangleCorners huge = makeRectangle({-1e7, -1e7, 1}, {2e7, 0, 0}, {0, 2e7, 0});
    EXPECT_NEAR(rectangleFormFactor({0, 0, 0}, {0, 0, 1}, huge), 1.0, 1e-6);
    EXPECT_NEAR(rectangleFormFactor({0, 0, 0}, {1, 0, 0}, huge), 0.5, 1e-6);
    EXPECT_EQ(rectangleFormFactor({0, 0, 0}, {0, 0, -1}, huge), 0.0);
    // In its own plane a rectangle fills nothing, at its corner neither.
    EXPECT_EQ(rectangleFormFactor({2, 0, 1}, {0, 0, -1}, makeRectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0})), 0.0);
    EXPECT_EQ(rectangleFormFactor({1, 1, 1}, {0, 0, -1}, makeRectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0})), 0.0);
    // Splitting it doesn't change the sum.
    const double whole = rectangleFormFactor({0.3, 0.2, 0}, {0, 0, 1}, makeRectangle({0, 0, 1}, {2, 0, 0}, {0, 1, 0}));
    const double parts = rectangleFormFactor({0.3, 0.2, 0}, {0, 0, 1}, makeRectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0})) +
                         rectangleFormFactor({0.3, 0.2, 0}, {0, 0, 1}, makeRectangle({1, 0, 1}, {1, 0, 0}, {0, 1, 0}));
    EXPECT_NEAR(whole, parts, 1e-15);
}

} // namespace q3rt::test
