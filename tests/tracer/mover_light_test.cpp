// Lights on moving brush models follow them.

#include <gtest/gtest.h>

#include "renderer_rt/world_lights.hpp"

namespace q3rt {
namespace {

TEST(MoverLight, KeepsItsShapeAndTurnsWithTheMover) {
    TriangleLight light;
    light.corner[0] = {8, 0, 0};
    light.corner[1] = {8, 16, 0};
    light.corner[2] = {8, 0, 16};
    light.normal = {1, 0, 0};
    light.areaQu2 = 128;
    light.radiance = {3, 2, 1};
    // A quarter turn about z, then 100 qu up.
    const mat4 transform(vec4(0, 1, 0, 0), vec4(-1, 0, 0, 0), vec4(0, 0, 1, 0), vec4(0, 0, 100, 1));
    const TriangleLight moved = moveLight(light, transform);
    EXPECT_EQ(moved.corner[0], vec3(0, 8, 100));
    EXPECT_EQ(moved.corner[1], vec3(-16, 8, 100));
    EXPECT_EQ(moved.corner[2], vec3(0, 8, 116));
    EXPECT_EQ(moved.normal, vec3(0, 1, 0));
    EXPECT_EQ(moved.areaQu2, light.areaQu2);
    EXPECT_EQ(moved.radiance, light.radiance);
}

} // namespace
} // namespace q3rt
