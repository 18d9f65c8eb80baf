// Which of the light grid's cells a point takes its light from: trilinear, the eight around it but those behind its
// surface. One text for the shaders and for what the processor makes of luxels (renderer_rt/grid_fit.cpp).
#ifndef Q3RT_LIB_GRID_MIX_GLSL
#define Q3RT_LIB_GRID_MIX_GLSL

struct GridShape {
    vec3 origin;   // of the first cell, qu
    vec3 cellSize; // qu
    ivec3 counts;
};

// A cell behind a surface stands in a wall or in the next room. It counts next to nothing, so only where there is no
// other; and fades out over less than a wall's thickness, so that light on bent surfaces has no steps.
const float kGridBehindShare = 1.0f / 1024.0f;
const float kGridBehindQu = 8.0f;

struct GridPlace {
    ivec3 low;     // the least of the eight cells
    vec3 fraction; // of the way to the next ones, [0, 1]
};

// Up to a cell's size beyond the grid, all of a world's bounds, its border goes on.
GridPlace placeInGrid(GridShape grid, vec3 point)
{
    vec3 scaled = (point - grid.origin) / grid.cellSize;
    GridPlace place;
    place.low = clamp(ivec3(floor(scaled)), ivec3(0), grid.counts - 1);
    place.fraction = clamp(scaled - vec3(place.low), vec3(0.0f), vec3(1.0f));
    return place;
}

struct GridCorner {
    uint cell;    // index of the cell
    float weight; // 0: there is none
};

// corner: 0 to 7. normal: of the surface, 0 where light from all sides counts.
GridCorner findGridCorner(GridShape grid, GridPlace place, vec3 normal, int corner)
{
    ivec3 step = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
    ivec3 at = min(place.low + step, grid.counts - 1);
    vec3 weights = mix(1.0f - place.fraction, place.fraction, vec3(step));
    float heightQu = dot(normal, (vec3(step) - place.fraction) * grid.cellSize);
    float share = clamp(1.0f + heightQu / kGridBehindQu, kGridBehindShare, 1.0f);
    GridCorner result;
    result.cell = uint(at.x + grid.counts.x * (at.y + grid.counts.y * at.z));
    result.weight = at == place.low + step ? weights.x * weights.y * weights.z * share : 0.0f;
    return result;
}

#endif
