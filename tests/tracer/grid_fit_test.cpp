// Cells of the light grid give the luxels around them what they lack: exactly where they can, evenly where they can't.

#include <gtest/gtest.h>
#include <random>

#include "renderer_rt/grid_fit.hpp"
#include "tests/truth/test_game.hpp"

namespace q3rt {
namespace {

/// In one place so many that what a cell begins with does not count: 2 of 2,000.
constexpr int kMany = 2000;
constexpr double kShare = 2.0 / kMany;
const vec3 kUp(0, 0, 1), kDown(0, 0, -1);

/// Two cells beside each other and one in a wall, 64 qu apart.
struct SmallGrid {
    LightGrid shape;
    std::vector<GridCell> cells{3};
    std::vector<LuxelLack> lacks;
    SmallGrid() {
        shape.origin = vec3(0);
        shape.cellSize = vec3(64);
        shape.counts = {3, 1, 1};
        for (GridCell& cell : cells)
            cell.direction = kUp;
        for (size_t i = 0; i < 2; ++i)
            cells[i].surfaces = {vec3(10, 2, 0), vec3(20, 4, 0), true};
    }
    void ask(float x, const vec3& normal, const vec3& light, int count = kMany, bool isThin = false) {
        for (int i = 0; i < count; ++i)
            lacks.push_back({vec3(x, 0, 0), normal, light, 0, isThin, true});
    }
    void fit() { fitGrid(shape, cells, lacks); }
    const GridShare& light(size_t i) const { return cells[i].surfaces; }
};

TEST(FitGrid, GivesWhatLacksToEachSide) {
    SmallGrid grid;
    grid.ask(0, kUp, vec3(90, 6, 0));
    grid.ask(0, kDown, vec3(10, 2, 0));
    grid.ask(64, kUp, vec3(5, -7, 40));
    grid.fit();
    EXPECT_NEAR(grid.light(0).ambient.x, 10, 300 * kShare) << "more and less than the map's cell has";
    EXPECT_NEAR(grid.light(0).directed.x, 80, 300 * kShare);
    EXPECT_NEAR(grid.light(0).ambient.y, 2, 300 * kShare);
    EXPECT_NEAR(grid.light(1).ambient.z + grid.light(1).directed.z, 40, 300 * kShare);
    EXPECT_EQ(grid.light(1).ambient.y + grid.light(1).directed.y, 0) << "too much already";
    EXPECT_TRUE(grid.cells[0].isFitted && grid.cells[1].isFitted && !grid.cells[2].isFitted);
}

TEST(FitGrid, WhatIsThinTakesLightFromBothSides) {
    SmallGrid grid;
    grid.ask(0, kDown, vec3(90), kMany, true);
    grid.ask(0, glm::vec3(1, 0, 0), vec3(10), kMany, true);
    grid.fit();
    EXPECT_NEAR(grid.light(0).directed.x, 80, 300 * kShare);
}

TEST(FitGrid, SharesAsTheShadersMix) {
    SmallGrid grid;
    grid.ask(0, kDown, vec3(0));
    grid.ask(48, kDown, vec3(12)); // a quarter of the first cell, three of the second
    grid.fit();
    EXPECT_NEAR(grid.light(0).ambient.x, 0, 12 * 0.01);
    EXPECT_NEAR(grid.light(1).ambient.x, 16, 16 * 0.01);
    SmallGrid wall; // its neighbour is in a wall: the second cell counts alone
    wall.ask(96, kDown, vec3(12));
    wall.fit();
    EXPECT_NEAR(wall.light(1).ambient.x, 12, 12 * kShare);
}

TEST(FitGrid, NoiseCancelsBeforeAnythingIsCutOff) {
    SmallGrid grid;
    std::mt19937 random(7);
    std::normal_distribution<float> noise(0, 50);
    for (int i = 0; i < kMany; ++i)
        grid.ask(0, kDown, vec3(10 + noise(random)), 1);
    grid.fit();
    EXPECT_NEAR(grid.light(0).ambient.x, 10, 4 * 50 / std::sqrt(kMany)) << "four standard errors";
}

TEST(FitGrid, ALuxelFarOffMakesNoCellBright) {
    SmallGrid grid;
    grid.ask(0, kDown, vec3(0));
    grid.ask(8, kDown, vec3(30), 1); // an eighth of the second cell: 240 would be needed
    grid.fit();
    EXPECT_LT(grid.light(1).ambient.x, 32);
    EXPECT_GT(grid.light(1).ambient.x, 20);
}

TEST(FitGrid, WhereNoLuxelTellsTheMeanDoes) {
    SmallGrid grid; // has 36 upwards, sum of the channels
    grid.ask(0, kUp, vec3(4, 5, 0));
    grid.fit();
    EXPECT_NEAR(grid.light(1).directed.y, 4 * 0.25, 1e-3);
    SmallGrid much;
    much.ask(0, kUp, vec3(200));
    much.fit();
    EXPECT_EQ(much.light(1).directed.y, 4) << "no more than the map has";
    SmallGrid unasked;
    unasked.fit();
    EXPECT_EQ(unasked.light(0).directed.y, 4) << "of a map without a luxel nothing is known";
}

TEST(OpenCells, EveryLuxelFindsLight) {
    test::TestGame game;
    TextureLibrary textures(game, {});
    MaterialLibrary materials(game, textures, {});
    const auto world = loadWorld(game, "maps/room_square_light.bsp", materials, {});
    LightAnimation animation(materials, textures);
    LightTables tables = buildLightTables(*world, materials, {}, {}, animation);
    for (GridCell& cell : tables.grid)
        cell.surfaces.valid = false;
    const ProbeGeometry geometry(*world, materials);
    const LightProbe probe(*world, geometry, tables);
    std::vector<LuxelLack> lacks = findLacks(*world, materials, tables.gridShape, probe, vec3(0), vec3(0));
    ASSERT_GT(lacks.size(), 100u);
    for (LuxelLack& lack : lacks)
        lack.light = vec3(50);
    std::vector<GridCell> open = tables.grid;
    openCells(*world, world->grid, open, lacks);
    for (size_t i = 0; i < open.size(); ++i)
        EXPECT_EQ(open[i].models.valid, tables.grid[i].models.valid) << "to models the map's grid is all that is known";
    fitGrid(world->grid, open, lacks);
    for (const GridCell& cell : open) {
        EXPECT_EQ(cell.isFitted, cell.surfaces.valid);
        if (cell.isFitted) {
            EXPECT_NEAR(cell.surfaces.ambient.x + 0.5f * cell.surfaces.directed.x, 50, 15);
        }
    }
    // A luxel in a wall, beyond the last cell: that one is opened for it, and no more.
    const vec3 last = world->grid.origin + world->grid.cellSize * vec3(world->grid.counts - 1);
    const vec3 outside = last + 0.5f * world->grid.cellSize;
    open = tables.grid;
    openCells(*world, world->grid, open, {{.position = outside, .normal = kUp, .light = vec3(50), .isOpen = true}});
    const auto count = std::count_if(open.begin(), open.end(), [](const GridCell& c) { return c.surfaces.valid; });
    EXPECT_EQ(count, 1) << "the grid's last";
    openCells(*world, world->grid, open, {});
    EXPECT_EQ(count, std::count_if(open.begin(), open.end(), [](const GridCell& c) { return c.surfaces.valid; }));
}

} // namespace
} // namespace q3rt
