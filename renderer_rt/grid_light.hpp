#pragma once
// What of the map's light grid the extracted lights explain, so that no light counts twice: a cell loses what they give
// there, shadows included. What stays is the light that was lost with the map's source, and bounces. Surfaces and
// models differ: on surfaces the lightmap knows better than the grid how much is missing (capGrid); of models, which
// hang in the air that no luxel sees, the grid is all that is known, as the engine shows it.

#include "renderer_rt/light_probe.hpp"

namespace q3rt {

/// Takes what the lights give from every cell of `grid`, and sets `sunSeen`. Returns what they give, by cell and way:
/// the first is the cell's direction. `shape`: of the map's grid, whose cells these are.
std::vector<ProbeWays> explainGrid(const LightProbe& probe, const LightGrid& shape, std::vector<GridCell>& grid);

/// On surfaces. No cell has less than the light that is everywhere: the grids of some compilers lack it. And each gets
/// what its directions lack, mean over them, of the least irradiance that the bake let a surface have. `explained` is
/// an estimate of a few rays and stands inside a maximum: its noise makes the result a little too bright. Luxel units.
void raiseGrid(std::vector<GridCell>& grid, const std::vector<ProbeWays>& explained, const vec3& ambient,
               const vec3& floor);

/// A point of a face.
struct LuxelLack {
    vec3 position{0}, normal{0};
    float light = 0; ///< irradiance that its luxel has and the lights do not give, sum of the channels; unbiased
    bool isOpen = false;
};

/// At points evenly over the lightmapped faces.
std::vector<LuxelLack> findLacks(const World& world, const MaterialLibrary& materials, const LightProbe& probe);

/// On surfaces. Darkens each cell to what the luxels that take light from it lack, mean over them: cells are coarse,
/// stand in the air, and some compilers made them brighter than the lightmap. A cell from which none takes light is
/// darkened as all are on the mean.
void capGrid(const LightGrid& shape, std::vector<GridCell>& grid, const std::vector<LuxelLack>& lacks);

} // namespace q3rt
