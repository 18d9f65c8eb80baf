#include "renderer_rt/packed_grid.hpp"

namespace q3rt {

namespace {

using namespace glm;
using glm::vec2;
using glm::vec3;
using uint = uint32_t;

#include "lib/grid_cell.glsl"

uvec4 pack(const GridCell& cell, const GridShare& light) {
    return packGridCell({light.ambient, light.directed, cell.direction, cell.sunSeen, light.valid});
}

} // namespace

std::vector<glm::uvec4> packGrid(const std::vector<GridCell>& grid) {
    std::vector<glm::uvec4> rows;
    rows.reserve(2 * grid.size());
    for (const GridCell& cell : grid) {
        rows.push_back(pack(cell, cell.surfaces));
        rows.push_back(pack(cell, cell.models));
    }
    return rows;
}

} // namespace q3rt
