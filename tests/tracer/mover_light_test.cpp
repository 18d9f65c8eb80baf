// Lights on what moves follow it: brush models, and surfaces that a script deforms.

#include <gtest/gtest.h>

#include "baseq3-test/bsp_writer.hpp"
#include "renderer_rt/world_lights.hpp"
#include "truth/picture_statistics.hpp"
#include "truth/square_room.hpp"
#include "truth/test_game.hpp"

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

constexpr IntBox kLava{{-64, -64, 0}, {64, 64, 0}};
constexpr int kLiftQu = 16, kWidth = 32, kHeight = 24;

/// The test room without its light, and a pool of light in its floor whose script lifts it.
std::vector<std::byte> makeLavaRoom() {
    BoxMap map = describeSquareLightRoom();
    map.panels = {{kLava, "textures/test/lava", squareLightRoom::kSurfaceLight, vec3(1)}};
    return writeBsp(buildBoxMap(map));
}

TEST(DeformedLight, ShinesFromWhereItsSurfaceIs) {
    test::TestGame game;
    game.add("maps/lava_room.bsp", makeLavaRoom());
    game.addText("scripts/lava.shader", "textures/test/lava\n{\nq3map_surfacelight 1000\nq3map_lightRGB 1 1 1\n"
                                        "deformVertexes move 0 0 16 sin 1 0 0 1\n{\nmap $whiteimage\n}\n}\n");
    test::TraceHarness harness(game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    harness.set("rt_backend", "compute");
    test::prepareHarness(harness, "lava_room", {});
    // Toward the ceiling, a wall's breadth beside the pool: where the map has it, its own lifted surface hides it.
    const test::Camera camera{.eye = {-150, -100, 100}, .pitch = -60, .yaw = 40, .fovX = 50};
    const FloatImage image = harness.radiance(camera, 96);
    IntBox lifted = kLava;
    lifted.mins.z = lifted.maxs.z = kLiftQu;
    double got = 0, expected = 0;
    int pixels = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const test::RoomPoint point = test::findRoomPoint(camera, kWidth, kHeight, x + 0.5, y + 0.5);
            if (point.normal.z >= 0) continue;
            expected += kTestWallAlbedo * 0.75 * double(squareLightRoom::kSurfaceLight) / 63.75 *
                        rectangleFormFactor(point.position, point.normal, computeCorners(lifted, 2, 1));
            got += double(image.rgb[static_cast<size_t>(3 * (y * kWidth + x))]);
            ++pixels;
        }
    EXPECT_GT(pixels, 200);
    EXPECT_NEAR(got / expected, 1, 0.005);
    std::printf("%d pixels of the ceiling: %.4f of the closed form\n", pixels, got / expected);
}

} // namespace
} // namespace q3rt
