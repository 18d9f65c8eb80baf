#pragma once
// What of the map's light grid the extracted lights explain, so that no light counts twice: the directed part of a cell
// loses what they give there, shadows included. What stays is the light that was lost with the map's source.

#include "renderer_rt/world_lights.hpp"

namespace q3rt {

/// Changes `directed` and sets `sunSeen` of every cell of `tables.grid`.
void explainGrid(const World& world, const MaterialLibrary& materials, LightTables& tables);

/// Darkens what stays where its mean is above that of the light that it stands for, channel by channel: the grid's
/// cells are coarse, and some compilers made it brighter than the lightmap. `mean`: irradiance, luxel units.
void limitGrid(std::vector<RtGridCell>& grid, const vec3& mean);

} // namespace q3rt
