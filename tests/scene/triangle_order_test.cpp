// sahLeafOrder returns every triangle once, whatever the input.

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "scene/triangle_order.hpp"

namespace q3rt::test {
namespace {

void expectPermutation(const std::vector<vec3>& corners) {
    const std::vector<uint32_t> order = sahLeafOrder(corners);
    ASSERT_EQ(order.size(), corners.size() / 3);
    std::vector<bool> seen(order.size(), false);
    for (const uint32_t triangle : order) {
        ASSERT_LT(triangle, order.size());
        ASSERT_FALSE(seen[triangle]);
        seen[triangle] = true;
    }
}

std::vector<vec3> randomTriangles(size_t count, float extent, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-extent, extent), size(-8, 8);
    std::vector<vec3> corners;
    for (size_t i = 0; i < count; ++i) {
        const vec3 centre(place(random), place(random), place(random));
        for (int k = 0; k < 3; ++k) {
            corners.push_back(centre + vec3(size(random), size(random), size(random)));
        }
    }
    return corners;
}

TEST(TriangleOrder, IsAPermutationForAnySize) {
    int cases = 0;
    for (const size_t count : {0u, 1u, 2u, 3u, 4u, 5u, 17u, 1000u, 20000u}) {
        SCOPED_TRACE(count);
        expectPermutation(randomTriangles(count, 4096, 7));
        ++cases;
    }
    EXPECT_EQ(cases, 9);
}

TEST(TriangleOrder, AcceptsDegenerateInput) {
    std::vector<vec3> same(3 * 500, vec3(1, 2, 3)); // all in one point
    expectPermutation(same);
    std::vector<vec3> huge = randomTriangles(100, 1e30f, 3);
    huge[0] = vec3(std::numeric_limits<float>::max());
    huge[1] = vec3(std::numeric_limits<float>::lowest());
    huge[7].x = std::numeric_limits<float>::quiet_NaN();
    huge[8].y = std::numeric_limits<float>::infinity();
    expectPermutation(huge);
    std::vector<vec3> line; // ever smaller distances: splits stay lopsided
    for (int i = 0; i < 200; ++i) {
        line.insert(line.end(), 3, vec3(std::ldexp(1.0f, -i), 0, 0));
    }
    expectPermutation(line);
}

TEST(TriangleOrder, NeighboursInOrderAreNeighboursInSpace) {
    const std::vector<vec3> corners = randomTriangles(4096, 4096, 11);
    const auto averageStep = [&](const std::vector<uint32_t>& order) {
        double sum = 0;
        for (size_t i = 1; i < order.size(); ++i) {
            sum += glm::distance(corners[3 * order[i]], corners[3 * order[i - 1]]);
        }
        return sum / static_cast<double>(order.size());
    };
    std::vector<uint32_t> fileOrder(corners.size() / 3);
    for (uint32_t i = 0; i < fileOrder.size(); ++i) {
        fileOrder[i] = i;
    }
    EXPECT_LT(averageStep(sahLeafOrder(corners)), 0.2 * averageStep(fileOrder));
}

} // namespace
} // namespace q3rt::test
