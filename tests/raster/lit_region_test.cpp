// What a dynamic light can't brighten is left out: against the light at every sample of a triangle, in double
// precision.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "renderer_vk/lit_region.hpp"

namespace q3rt {
namespace {

constexpr int kSizePx = 32;
constexpr double kPictureReach =
    7.5 / 16.0; // of the radius, from the middle of the light's picture to its black border

TriangleView perspectiveView() {
    TriangleView view;
    view.sizePx = vec2(kSizePx);
    view.clipFromModel = mat4(0.0f); // looks along +y; w and depth = y, the model's z points up
    view.clipFromModel[0][0] = 1;
    view.clipFromModel[2][1] = -1;
    view.clipFromModel[1][2] = view.clipFromModel[1][3] = 1;
    return view;
}

/// As the vertex shader has it.
double strengthAt(const RasterLight& light, const vec3& corner) {
    const double height = std::abs(static_cast<double>(light.origin.z) - corner.z), radius = light.radius;
    return height > radius ? 0.0 : height < radius / 2 ? 1.0 : 2.0 * (radius - height) / radius;
}

/// Samples of the view in which the light adds something to the triangle.
std::vector<glm::ivec2> litSamples(const std::array<Vertex, 3>& corners, const RasterLight& light) {
    std::vector<glm::ivec2> lit;
    const glm::dvec3 a(corners[0].position), ab = glm::dvec3(corners[1].position) - a,
                                             ac = glm::dvec3(corners[2].position) - a;
    for (int y = 0; y < kSizePx; ++y)
        for (int x = 0; x < kSizePx; ++x) {
            const glm::dvec3 ray((x + 0.5) / kSizePx * 2 - 1, 1, 1 - (y + 0.5) / kSizePx * 2);
            // ray t = a + u ab + v ac
            const glm::dvec3 s = glm::inverse(glm::dmat3(ray, -ab, -ac)) * a;
            const double t = s.x, u = s.y, v = s.z;
            if (!(t > 0 && u >= 0 && v >= 0 && u + v <= 1)) continue;
            const glm::dvec3 away = ray * t - glm::dvec3(light.origin);
            const double strength = (1 - u - v) * strengthAt(light, corners[0].position) +
                                    u * strengthAt(light, corners[1].position) +
                                    v * strengthAt(light, corners[2].position);
            if (strength > 0 && std::max(std::abs(away.x), std::abs(away.y)) < kPictureReach * light.radius)
                lit.emplace_back(x, y);
        }
    return lit;
}

TEST(LitRegion, WhatIsLeftOutGetsNoLight) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-60.0f, 60.0f), ahead(-40.0f, 160.0f), size(5.0f, 120.0f);
    const TriangleView view = perspectiveView();
    int lit = 0, leftOut = 0;
    int64_t boxed = 0, litPixels = 0;
    constexpr int kCases = 4000;
    for (int i = 0; i < kCases; ++i) {
        RasterLight light{};
        light.origin = vec3(place(random), ahead(random), place(random));
        light.radius = size(random);
        std::array<Vertex, 3> corners{};
        for (Vertex& corner : corners)
            corner.position = vec3(place(random), ahead(random), place(random));
        std::vector<uint32_t> indices = {0, 1, 2};
        const PixelBox box = appendLitTriangles(view, light, corners, indices, 0, 3);
        const std::vector<glm::ivec2> samples = litSamples(corners, light);
        for (const glm::ivec2& p : samples) {
            EXPECT_EQ(indices.size(), 6u) << "case " << i;
            EXPECT_TRUE(p.x >= box.from.x && p.y >= box.from.y && p.x < box.to.x && p.y < box.to.y) << "case " << i;
        }
        EXPECT_EQ(box.empty(), indices.size() == 3) << "case " << i;
        leftOut += indices.size() == 3 ? 1 : 0;
        lit += samples.empty() ? 0 : 1;
        if (samples.empty()) continue;
        boxed += int64_t{box.to.x - box.from.x} * (box.to.y - box.from.y);
        litPixels += static_cast<int64_t>(samples.size());
    }
    EXPECT_GT(lit, kCases / 10);
    EXPECT_GT(leftOut, kCases / 4);
    EXPECT_LT(boxed, litPixels * 4) << "boxes are many times as large as what they hold";
}

TEST(LitRegion, TrianglesStayInTheirOrderAndTheLitOnesAreAppended) {
    const TriangleView view = perspectiveView();
    RasterLight light{};
    light.origin = vec3(0, 50, 0);
    light.radius = 20;
    std::vector<Vertex> vertices;
    for (const float x : {0.0f, 30.0f, 2.0f}) // lit, beside the light, lit
        for (const vec3& corner : {vec3(-4, 52, -4), vec3(0, 52, 4), vec3(4, 52, -4)}) {
            vertices.emplace_back();
            vertices.back().position = corner + vec3(x, 0, 0);
        }
    std::vector<uint32_t> indices = {9, 0, 1, 2, 3, 4, 5, 6, 7, 8}; // one that is another batch's comes first
    appendLitTriangles(view, light, vertices, indices, 1, 9);
    EXPECT_EQ(indices, (std::vector<uint32_t>{9, 0, 1, 2, 3, 4, 5, 6, 7, 8, 0, 1, 2, 6, 7, 8}));
}

} // namespace
} // namespace q3rt
