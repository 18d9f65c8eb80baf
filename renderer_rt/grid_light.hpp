#pragma once
// What of the map's light grid the extracted lights explain, so that no light counts twice: a cell loses what they give
// there, shadows included. What stays is the light that was lost with the map's source, and bounces. Surfaces and
// models differ: on surfaces the lightmap knows better than the grid how much is missing (grid_fit.hpp); of models,
// which hang in the air that no luxel sees, the grid is all that is known, as the engine shows it.

#include "renderer_rt/light_probe.hpp"

namespace q3rt {

/// Takes what the lights give from every cell of `grid`, and sets `sunSeen`. Returns what they give, by cell and way:
/// the first is the cell's direction. `shape`: of the map's grid, whose cells these are.
std::vector<ProbeWays> explainGrid(const LightProbe& probe, const LightGrid& shape, std::vector<GridCell>& grid);

/// The point where a cell stands.
vec3 pointOf(const LightGrid& shape, size_t cell);

/// On surfaces, what no luxel told (fitGrid): light that is everywhere is added where luxels did not count it as
/// lacking. No other cell has less than it: the grids of some compilers lack it. And those get what their directions
/// lack, mean over them, of the least irradiance that the bake let a surface have. `explained` is an estimate of a few
/// rays and stands inside a maximum: its noise makes the result a little too bright. Luxel units.
void raiseGrid(std::vector<GridCell>& grid, const std::vector<ProbeWays>& explained, const vec3& ambient,
               const vec3& floor);

} // namespace q3rt
