#pragma once
// What of the map's light grid the extracted lights explain, so that no light counts twice: a cell loses what they give
// there, shadows included. What stays is the light that was lost with the map's source. Surfaces and models differ: on
// surfaces the lightmap knows better than the grid how much is missing (limitGrid, raiseGrid); of models, which hang in
// the air that no luxel sees, the grid is all that is known, as the engine shows it.

#include <array>

#include "renderer_rt/world_lights.hpp"

namespace q3rt {

/// Directions of a cell: its own, the opposite one, four across.
inline constexpr size_t kGridWays = 6;
/// Irradiance of a surface that faces them, luxel units.
using GridIrradiance = std::array<vec3, kGridWays>;

/// Takes what the lights give from every cell of `tables.grid`, and sets `sunSeen`. Returns what they give, by cell.
std::vector<GridIrradiance> explainGrid(const World& world, const MaterialLibrary& materials, LightTables& tables);

/// On surfaces. What stays is light that is everywhere (`ambient`) and bounces. Darkens the bounces where their mean is
/// above that of the light that they stand for, channel by channel: the grid's cells are coarse, and some compilers
/// made it brighter than the lightmap. `mean` of both: irradiance, luxel units. The grid of some compilers has no light
/// that is everywhere; here every cell gets it, once.
void limitGrid(std::vector<RtGridCell>& grid, const vec3& mean, const vec3& ambient);

/// On surfaces. Adds to each cell what its directions lack of the least irradiance that the bake let a surface have,
/// mean over them. `explained` is an estimate of a few rays and stands inside a maximum: its noise makes the result a
/// little too bright.
void raiseGrid(std::vector<RtGridCell>& grid, const std::vector<GridIrradiance>& explained, const vec3& floor);

} // namespace q3rt
