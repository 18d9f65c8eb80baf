#pragma once
// The light grid on surfaces, as the lightmap wants it: each cell gives what the luxels that take light from it lack.
// The lightmap knows better than the grid how much light is missing, and where: cells are coarse, stand in the air,
// some compilers made them brighter than the lightmap, and small rooms may have none that is not in a wall.

#include "renderer_rt/light_probe.hpp"

namespace q3rt {

/// A point of a lightmapped face.
struct LuxelLack {
    vec3 position{0}, normal{0};
    vec3 light{0};       ///< irradiance that it should have and that the lights do not give; unbiased, luxel units
    float sunSeen = 0;   ///< share of the suns' light that arrives
    bool isThin = false; ///< takes light from both sides
    bool isOpen = false; ///< not covered by another face
    float weight = 1;    ///< how much it counts in the fit
};

/// At points evenly over the lightmapped faces. `ambient`, light that is everywhere, counts as lights do; and each
/// luxel should have `floor` at least.
std::vector<LuxelLack> findLacks(const World& world, const MaterialLibrary& materials, const LightGrid& shape,
                                 const LightProbe& probe, const vec3& ambient, const vec3& floor);

/// Cells that the map left dark become cells of surfaces where luxels may take light from them: all that stand in open
/// space, and those in walls around luxels that have no other before them.
void openCells(const World& world, const LightGrid& shape, std::vector<GridCell>& grid,
               const std::vector<LuxelLack>& lacks);

/// What the cells of surfaces give becomes what best gives all luxels what they lack, by least squares, nothing below
/// 0; so no light counts twice, and the light of a room that shares cells with the next one is what suits both. Cells
/// begin with the mean that their luxels lack, and stay near it where few luxels tell. A cell from which no luxel takes
/// light is darkened as all cells are on the mean. `shape`: of the map's grid.
void fitGrid(const LightGrid& shape, std::vector<GridCell>& grid, const std::vector<LuxelLack>& lacks);

/// All of it on the grid of `tables`, in order: what the lights of `probe` explain (grid_light.hpp), what luxels lack,
/// and what is everywhere.
void explainGrid(const World& world, const MaterialLibrary& materials, const LightProbe& probe, const LightSet& lights,
                 LightTables& tables);

/// What the cells give a luxel, as the shaders mix them (shaders/rt/grid.glsl), luxel units.
vec3 lightOfGrid(const LightGrid& shape, const std::vector<GridCell>& grid, const LuxelLack& luxel);

} // namespace q3rt
