// The ambient term: the map's light grid at a point.
#ifndef Q3RT_RT_GRID_GLSL
#define Q3RT_RT_GRID_GLSL
#include "lib/grid_mix.glsl"
#include "rt/rows.glsl"
#include "rt/scene.glsl"

struct GridSample {
    vec3 irradiance; // luxel units
    float sunSeen;   // [0, 1]
};

// Of the cells before the surface that are not inside walls; no light, and all of the sky, where there are none.
// `lit`: kLit*; on what is thin light along the normal counts whichever way it goes.
GridSample sampleGrid(vec3 point, vec3 normal, uint lit)
{
    GridSample result = GridSample(vec3(0.0), 1.0);
    if ((rtFrame.flags & kFrameGrid) == 0u)
        return result;
    float sunSeen = 0.0;
    GridShape grid;
    grid.origin = rtFrame.gridOrigin;
    grid.cellSize = rtFrame.gridCellSize;
    grid.counts = rtFrame.gridCounts;
    GridPlace place = placeInGrid(grid, point);
    vec3 front = (lit & (kLitThin | kLitModel)) != 0u ? vec3(0.0) : normal;
    uint taker = (lit & kLitModel) != 0u ? 1u : 0u;
    vec3 ambient = vec3(0.0), directed = vec3(0.0), direction = vec3(0.0);
    float total = 0.0;
    // Unrolled and without a branch: the eight reads are under way together.
    UNROLL for (int corner = 0; corner < 8; ++corner) {
        GridCorner at = findGridCorner(grid, place, front, corner);
        GridCellLight sampled = loadGridCell(rtFrame.grid, at.cell, taker);
        float weight = sampled.valid ? at.weight : 0.0;
        ambient += sampled.ambient * weight;
        directed += sampled.directed * weight;
        direction += sampled.direction * weight;
        sunSeen += sampled.sunSeen * weight;
        total += weight;
    }
    if (total <= 0.0)
        return result;
    float size2 = dot(direction, direction);
    float facing = size2 > 0.0 ? dot(normal, direction) * inversesqrt(size2) : 0.0;
    result.irradiance = (ambient + directed * ((lit & kLitThin) != 0u ? abs(facing) : max(0.0, facing))) / total;
    result.sunSeen = sunSeen / total;
    return result;
}

#endif
