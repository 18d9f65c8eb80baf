// Where the near depth range can be seen: no point of a near triangle is outside, wherever it lies about the eye.

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "renderer_rt/near_area.hpp"
#include "scene/scene_types.hpp"

namespace q3rt {
namespace {

RtFrame cameraAt(const vec3& eye) {
    RtFrame frame{};
    frame.eye = eye;
    // The centre is off the axis, as where a view is cut.
    frame.forward = {0.6f, 0.8f, 0.1f};
    frame.left = {-0.8f, 0.6f, 0};
    frame.up = {0, 0, 0.75f};
    frame.size = {320, 240};
    return frame;
}

ViewGeometry nearTriangle(const std::array<vec3, 3>& corners, uint32_t flags = entityFlag::kDepthHack) {
    ViewGeometry geometry;
    geometry.entities.resize(2);
    geometry.entities[1].flags = flags;
    for (const vec3& corner : corners) {
        geometry.indices.push_back(static_cast<uint32_t>(geometry.vertices.size()));
        geometry.vertices.emplace_back().position = corner;
    }
    EntitySurface surface;
    surface.entity = 1;
    surface.vertexCount = surface.indexCount = 3;
    geometry.surfaces.push_back(surface);
    return geometry;
}

TEST(NearArea, HoldsEveryPointThatIsSeen) {
    std::mt19937 random(1);
    const auto number = [&] { return std::uniform_real_distribution<float>(-1, 1)(random); };
    const vec3 eye(4096, -300, 77);
    const RtFrame frame = cameraAt(eye);
    const glm::dmat3 amounts = glm::inverse(glm::dmat3(dvec3(frame.forward), dvec3(frame.left), dvec3(frame.up)));
    size_t seen = 0, small = 0;
    for (int i = 0; i < 20000; ++i) {
        std::array<vec3, 3> corners;
        const vec3 place(30 * number(), 30 * number(), 30 * number());
        for (vec3& corner : corners)
            corner = eye + place + vec3(number(), number(), number()) * 20.0f;
        const vec4 area = findNearArea(nearTriangle(corners), frame);
        for (int k = 0; k < 20; ++k) {
            double u = 0.5 + 0.5 * static_cast<double>(number()), v = 0.5 + 0.5 * static_cast<double>(number());
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const dvec3 point = dvec3(corners[0]) + (dvec3(corners[1]) - dvec3(corners[0])) * u +
                                (dvec3(corners[2]) - dvec3(corners[0])) * v;
            const dvec3 along = amounts * (point - dvec3(eye));
            if (along.x <= 0) continue;
            const double x = (1 - along.y / along.x) * 160, y = (1 - along.z / along.x) * 120;
            ++seen;
            ASSERT_TRUE(x >= static_cast<double>(area.x) && x <= static_cast<double>(area.z)) << i;
            ASSERT_TRUE(y >= static_cast<double>(area.y) && y <= static_cast<double>(area.w)) << i;
        }
        small += area.z - area.x < 320 ? 1 : 0;
    }
    EXPECT_GT(seen, 100000u);
    EXPECT_GT(small, 2000u) << "areas must leave something out";
}

TEST(NearArea, IsAsLargeAsWhatIsThere) {
    const vec3 eye(0);
    const RtFrame frame = cameraAt(eye);
    const auto at = [&](float left, float up) { return frame.forward * 10.0f + frame.left * left + frame.up * up; };
    const std::array<vec3, 3> corners{at(0, 0), at(-5, 0), at(0, 5)};
    const vec4 area = findNearArea(nearTriangle(corners), frame);
    EXPECT_NEAR(area.x, 159, 0.01f);
    EXPECT_NEAR(area.z, 241, 0.01f);
    EXPECT_NEAR(area.y, 59, 0.01f);
    EXPECT_NEAR(area.w, 121, 0.01f);
    const vec4 none = findNearArea(nearTriangle(corners, 0), frame);
    EXPECT_GT(none.x, none.z);
    const vec4 behind = findNearArea(nearTriangle({-corners[0], -corners[1], -corners[2]}), frame);
    EXPECT_GT(behind.x, behind.z);
    const vec4 odd = findNearArea(nearTriangle({corners[0], corners[1], vec3(NAN)}), frame);
    EXPECT_TRUE(odd.x < 0 && odd.z > 320) << "whatever it is, it may be anywhere";
}

} // namespace
} // namespace q3rt
