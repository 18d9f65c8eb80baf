// The light grid's placement and interpolation (spec of world 1.5, 7.1), and entity lighting on top of it.

#include <random>

#include <gtest/gtest.h>

#include "scene/entity_geometry.hpp"
#include "scene/wave.hpp"
#include "scene_fixture.hpp"

namespace q3rt::test {
namespace {

Bsp makeGridBsp(const vec3& mins, const vec3& maxs, size_t cells) {
    Bsp bsp;
    bsp.models.resize(1);
    bsp.models[0].mins = mins;
    bsp.models[0].maxs = maxs;
    bsp.lightGrid.assign(cells * 8, 0);
    return bsp;
}

void setCell(Bsp& bsp, size_t cell, U8vec4 ambient, U8vec4 directed, uint8_t polar, uint8_t azimuth) {
    const uint8_t record[8] = {ambient.r, ambient.g, ambient.b, directed.r, directed.g, directed.b, polar, azimuth};
    std::copy(record, record + 8, bsp.lightGrid.begin() + static_cast<std::ptrdiff_t>(cell * 8));
}

TEST(LightGrid, IsPlacedOnMultiplesOfTheCellInsideTheMap) {
    // x: ceil(-100/64) = -1, floor(130/64) = 2 -> 4 cells; y: 0..1 -> 2; z: -1..0 -> 2
    const Bsp bsp = makeGridBsp({-100, -10, -128}, {130, 64, 100}, 4 * 2 * 2);
    const LightGrid grid = LightGrid::build(bsp, {64, 64, 128}, 2);
    ASSERT_FALSE(grid.empty());
    EXPECT_EQ(grid.counts, ivec3(4, 2, 2));
    EXPECT_EQ(grid.origin, vec3(-64, 0, -128));
}

TEST(LightGrid, WrongSizeGivesNoGridAndOneWarning) {
    const LogCapture log;
    const Bsp bsp = makeGridBsp({-100, -10, -128}, {130, 64, 100}, 15);
    EXPECT_TRUE(LightGrid::build(bsp, {64, 64, 128}, 2).empty());
    EXPECT_EQ(log.count("light grid ignored"), 1u);
}

TEST(LightGrid, InterpolatesAndSkipsCellsInsideWalls) {
    Bsp bsp = makeGridBsp({0, 0, 0}, {64, 0, 0}, 2);
    setCell(bsp, 0, {10, 20, 30, 0}, {40, 40, 40, 0}, 0, 0);
    setCell(bsp, 1, {50, 20, 10, 0}, {0, 0, 0, 0}, 0, 0);
    const LightGrid grid = LightGrid::build(bsp, {64, 64, 128}, 0);
    const GridLight middle = grid.sample({16, 0, 0});
    EXPECT_NEAR(middle.ambient.r, 20, 1e-4f);
    EXPECT_NEAR(middle.directed.g, 30, 1e-4f);
    EXPECT_NEAR(middle.direction.z, 1, 1e-6f);
    setCell(bsp, 1, {0, 0, 0, 0}, {99, 99, 99, 0}, 0, 0); // in a wall: its weight is given to the rest
    const GridLight beside = LightGrid::build(bsp, {64, 64, 128}, 0).sample({16, 0, 0});
    EXPECT_NEAR(beside.ambient.r, 10, 1e-4f);
    EXPECT_NEAR(beside.directed.r, 40, 1e-4f);
}

TEST(LightGrid, DirectionUsesTheSineTableOf1023) {
    Bsp bsp = makeGridBsp({0, 0, 0}, {0, 0, 0}, 1);
    int cases = 0;
    for (int polar = 0; polar < 256; polar += 15) {
        for (int azimuth = 0; azimuth < 256; azimuth += 15, ++cases) {
            setCell(bsp, 0, {1, 1, 1, 0}, {1, 1, 1, 0}, static_cast<uint8_t>(polar), static_cast<uint8_t>(azimuth));
            const GridLight light = LightGrid::build(bsp, {64, 64, 128}, 0).sample({0, 0, 0});
            const auto s = [](int i) { return sineTable(i & 1023); };
            const vec3 expected(s(4 * azimuth + 256) * s(4 * polar), s(4 * azimuth) * s(4 * polar), s(4 * polar + 256));
            EXPECT_NEAR(glm::distance(light.direction, glm::normalize(expected)), 0, 1e-6f);
        }
    }
    EXPECT_EQ(cases, 324);
}

TEST(LightGrid, PointsOutsideKeepTheFractionOfTheirOwnCell) {
    Bsp bsp = makeGridBsp({0, 0, 0}, {64, 0, 0}, 2);
    setCell(bsp, 0, {10, 10, 10, 0}, {10, 10, 10, 0}, 0, 0);
    setCell(bsp, 1, {30, 30, 30, 0}, {10, 10, 10, 0}, 0, 0);
    const LightGrid grid = LightGrid::build(bsp, {64, 64, 128}, 0);
    // x = -16: cell -1, fraction 0.75, clamped to cell 0: 0.25 * 10 + 0.75 * 30
    EXPECT_NEAR(grid.sample({-16, 0, 0}).ambient.r, 25, 1e-4f);
}

TEST(EntityLight, EveryEntityGetsTheMinimumAndDynamicLightsAdd) {
    FrameCommands frame;
    SceneView view;
    SceneEntity entity;
    ViewGeometrySettings settings;
    const EntityLight unlit = computeEntityLight(nullptr, vec3(0), entity, frame, view, settings);
    EXPECT_EQ(unlit.ambient, vec3(182)); // 150 + 32: menu models before the first map
    EXPECT_EQ(unlit.direction, vec3(0));
    frame.lights.push_back({vec3(0, 0, 100), 50, vec3(1, 0.5f, 0), false});
    view.lightCount = 1;
    const EntityLight lit = computeEntityLight(nullptr, vec3(0), entity, frame, view, settings);
    EXPECT_NEAR(lit.directed.r - unlit.directed.r, 16.0f * 2500 / 10000, 1e-4f);
    EXPECT_NEAR(lit.directed.g - unlit.directed.g, 8.0f * 2500 / 10000, 1e-4f);
    EXPECT_NEAR(lit.direction.z, 1, 1e-6f);
}

TEST(EntityLight, ScaledAxesScaleTheDirection) {
    SceneEntity entity;
    for (vec3& axis : entity.orientation.axis) {
        axis *= 0.25f;
    }
    const EntityLight light = computeEntityLight(nullptr, glm::normalize(vec3(0.45f, 0.3f, 0.9f)), entity,
                                                 FrameCommands{}, SceneView{}, ViewGeometrySettings{});
    EXPECT_NEAR(glm::length(light.direction), 0.25f, 1e-6f);
}

} // namespace
} // namespace q3rt::test
