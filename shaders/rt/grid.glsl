// The ambient term: the map's light grid at a point.
#ifndef Q3RT_RT_GRID_GLSL
#define Q3RT_RT_GRID_GLSL
#include "rt/rows.glsl"
#include "rt/scene.glsl"

struct GridSample {
    vec3 irradiance; // luxel units
    float sunSeen;   // [0, 1]
};

// Trilinear over the cells that are not inside walls; no light, and all of the sky, where there are none. `lit`: kLit*;
// on what is thin light along the normal counts whichever way it goes.
GridSample sampleGrid(vec3 point, vec3 normal, uint lit)
{
    GridSample result = GridSample(vec3(0.0), 1.0);
    if ((rtFrame.flags & kFrameGrid) == 0u)
        return result;
    float sunSeen = 0.0;
    vec3 v = (point - rtFrame.gridOrigin) / rtFrame.gridCellSize;
    ivec3 cell = clamp(ivec3(floor(v)), ivec3(0), rtFrame.gridCounts - 1);
    vec3 f = clamp(v - vec3(cell), vec3(0.0), vec3(1.0));
    uint taker = (lit & kLitModel) != 0u ? 1u : 0u;
    vec3 ambient = vec3(0.0), directed = vec3(0.0), direction = vec3(0.0);
    float total = 0.0;
    // Unrolled and without a branch: the eight reads are under way together.
    UNROLL for (int corner = 0; corner < 8; ++corner) {
        ivec3 step = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        ivec3 at = min(cell + step, rtFrame.gridCounts - 1);
        bool inside = at == cell + step;
        vec3 axisWeights = mix(1.0 - f, f, vec3(step));
        int cellIndex = at.x + rtFrame.gridCounts.x * (at.y + rtFrame.gridCounts.y * at.z);
        GridCellLight sampled = loadGridCell(rtFrame.grid, uint(cellIndex), taker);
        float weight = sampled.valid && inside ? axisWeights.x * axisWeights.y * axisWeights.z : 0.0;
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
