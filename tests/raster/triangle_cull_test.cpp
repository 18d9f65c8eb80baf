// Triangles left out before drawing: none of them has a sample to show. Against a rasteriser in double precision.

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "scene/triangle_cull.hpp"

namespace q3rt {
namespace {

constexpr int kSizePx = 24;

/// Samples that the triangle covers, edges included, if it shows the side that is wanted.
int coveredSamples(const TriangleView& view, const std::array<Vertex, 3>& corners) {
    std::array<glm::dvec2, 3> px;
    for (size_t i = 0; i < 3; ++i) {
        const glm::dvec4 clip = glm::dmat4(view.clipFromModel) * glm::dvec4(corners[i].position, 1.0);
        px[i] = (glm::dvec2(clip) / clip.w + 1.0) * 0.5 * glm::dvec2(view.sizePx);
    }
    const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
    const double area = cross(px[1] - px[0], px[2] - px[0]);
    const bool front = (area > 0) != view.mirrored;
    if (area == 0 || (view.cull == CullMode::Front && !front) || (view.cull == CullMode::Back && front)) return 0;
    int covered = 0;
    for (int y = 0; y < kSizePx; ++y)
        for (int x = 0; x < kSizePx; ++x) {
            const glm::dvec2 sample(x + 0.5, y + 0.5);
            int inside = 0;
            for (size_t i = 0; i < 3; ++i)
                inside += cross(px[(i + 1) % 3] - px[i], sample - px[i]) * area >= 0 ? 1 : 0;
            covered += inside == 3 ? 1 : 0;
        }
    return covered;
}

TEST(TriangleCull, WhatIsLeftOutCoversNoSample) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-1.4f, 1.4f), logSize(-6.0f, 0.5f), depth(5.0f, 40.0f);
    TriangleCuller culler;
    int leftOut = 0, needless = 0;
    constexpr int kTriangles = 20000;
    for (int i = 0; i < kTriangles; ++i) {
        TriangleView view;
        view.sizePx = vec2(kSizePx);
        view.cull = static_cast<CullMode>(i % 3);
        view.mirrored = i % 2 != 0;
        view.clipFromModel = mat4(0.0f); // w and depth = z
        view.clipFromModel[0][0] = view.clipFromModel[1][1] = view.clipFromModel[2][2] = 1;
        view.clipFromModel[2][3] = 1;
        std::array<Vertex, 3> corners{};
        const vec2 middle(place(random), place(random));
        const float size = std::exp(logSize(random));
        for (Vertex& corner : corners) {
            const float z = depth(random);
            corner.position = vec3((middle + size * vec2(place(random), place(random))) * z, z);
        }
        std::vector<uint32_t> indices = {0, 1, 2};
        culler.cull(view, corners, indices, 0);
        const int covered = coveredSamples(view, corners);
        if (indices.empty()) {
            EXPECT_EQ(covered, 0) << "triangle " << i;
            ++leftOut;
        } else if (covered == 0) {
            ++needless;
        }
    }
    EXPECT_GT(leftOut, kTriangles / 2);
    EXPECT_LT(needless, kTriangles / 20); // slivers, and corners between many samples
}

TEST(TriangleCull, ARectangleShowsWhereItHoldsThePixelsMiddle) {
    const vec2 view(kSizePx);
    EXPECT_TRUE(rectangleShows({3.4f, 3.4f}, {3.6f, 3.6f}, view));
    EXPECT_TRUE(rectangleShows({3.6f, 3.6f}, {3.4f, 3.4f}, view)) << "turned round";
    EXPECT_FALSE(rectangleShows({3.6f, 3.0f}, {4.4f, 4.0f}, view)) << "between columns";
    EXPECT_FALSE(rectangleShows({3.0f, 3.6f}, {4.0f, 4.4f}, view)) << "between rows";
    EXPECT_TRUE(rectangleShows({-100.0f, -100.0f}, {100.0f, 100.0f}, view));
    EXPECT_FALSE(rectangleShows({kSizePx, 0.0f}, {kSizePx + 8.0f, 8.0f}, view)) << "right of the picture";
}

TEST(TriangleCull, NothingBehindTheEyeIsJudgedByItsPlace) {
    TriangleView view;
    view.sizePx = vec2(kSizePx);
    view.clipFromModel = mat4(0.0f);
    view.clipFromModel[0][0] = view.clipFromModel[1][1] = view.clipFromModel[2][2] = 1;
    view.clipFromModel[3][2] = -4; // near plane at 4
    view.clipFromModel[2][3] = 1;
    const auto kept = [&](const vec3& a, const vec3& b, const vec3& c) {
        std::array<Vertex, 3> corners{};
        corners[0].position = a;
        corners[1].position = b;
        corners[2].position = c;
        std::vector<uint32_t> indices = {9, 9, 9, 0, 1, 2};
        TriangleCuller culler;
        culler.cull(view, corners, indices, 3);
        EXPECT_EQ(indices[0], 9u) << "what was there before stays";
        return indices.size() == 6;
    };
    EXPECT_TRUE(kept({0, 0, 8}, {1, 0, -8}, {0, 1, 8})) << "through the eye's plane, either side may show";
    EXPECT_TRUE(kept({0, 0, 8}, {0, 1, 8}, {1, 0, -8}));
    EXPECT_FALSE(kept({0, 0, -8}, {1, 0, -8}, {0, 1, -8})) << "all behind";
    EXPECT_FALSE(kept({0, 0, 2}, {1, 0, 2}, {0, 1, 2})) << "all nearer than the near plane";
    EXPECT_FALSE(kept({90, 0, 8}, {91, 0, 8}, {90, 1, 8})) << "to the right";
}

} // namespace
} // namespace q3rt
