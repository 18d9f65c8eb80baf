// Cells of the light grid survive their packing within the bounds that lib/grid_cell.glsl states.

#include <gtest/gtest.h>
#include <random>

#include "renderer_rt/packed_grid.hpp"
#include "shader_text.hpp"

namespace q3rt {
namespace shader {
namespace {
#include "lib/grid_cell.glsl"
} // namespace
} // namespace shader

namespace {

void expectNear(const vec3& packed, const vec3& given) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(packed[c], std::min(given[c], shader::kGridLightMax), given[c] / 2048 + 1e-7f);
}

TEST(PackedGrid, KeepsCells) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> light(0, 300), unit(-1, 1), share(0, 1);
    std::vector<GridCell> grid;
    for (int i = 0; i < 5000; ++i) {
        GridCell cell{};
        cell.surfaces = {vec3(light(random), 0, light(random)), vec3(light(random), 1e-3f, 70000), i % 2 == 0};
        cell.models = {vec3(1, light(random), 2), vec3(0), i % 3 == 0};
        cell.direction = glm::normalize(vec3(unit(random), unit(random), unit(random) + 1e-3f));
        cell.sunSeen = share(random);
        grid.push_back(cell);
    }
    const std::vector<glm::uvec4> rows = packGrid(grid);
    ASSERT_EQ(rows.size(), 2 * grid.size());
    for (size_t i = 0; i < rows.size(); ++i) {
        const GridCell& cell = grid[i / 2];
        const GridShare& given = i % 2 == 0 ? cell.surfaces : cell.models;
        const shader::GridCellLight packed = shader::unpackGridCell(rows[i]);
        expectNear(packed.ambient, given.ambient);
        expectNear(packed.directed, given.directed);
        EXPECT_LT(glm::length(packed.direction - cell.direction), 1e-3f);
        EXPECT_NEAR(packed.sunSeen, cell.sunSeen, 1.0f / 128);
        EXPECT_EQ(packed.valid, given.valid);
    }
}

TEST(PackedGrid, LightFromNowhereIsNone) {
    GridCell cell{};
    cell.surfaces.directed = vec3(9);
    cell.surfaces.valid = true;
    EXPECT_EQ(shader::unpackGridCell(packGrid({cell})[0]).directed, vec3(0));
}

} // namespace
} // namespace q3rt
