#pragma once
// The light grid as shaders read it (shaders/lib/grid_cell.glsl).

#include "renderer_rt/world_lights.hpp"

namespace q3rt {

/// Two rows a cell: as surfaces take it, as models do.
std::vector<glm::uvec4> packGrid(const std::vector<GridCell>& grid);

} // namespace q3rt
