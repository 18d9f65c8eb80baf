// The ambient term: the map's light grid at a point.
#ifndef Q3RT_RT_GRID_GLSL
#define Q3RT_RT_GRID_GLSL
#include "rt/scene.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer GridTable { RtGridCell at[]; };

// Trilinear over the cells that are not inside walls, in luxel units; 0 where the map has no grid.
vec3 ambientIrradiance(vec3 point, vec3 normal)
{
    if ((rtFrame.flags & kFrameGrid) == 0u)
        return vec3(0.0);
    vec3 v = (point - rtFrame.gridOrigin) / rtFrame.gridCellSize;
    ivec3 cell = clamp(ivec3(floor(v)), ivec3(0), rtFrame.gridCounts - 1);
    vec3 f = clamp(v - vec3(cell), vec3(0.0), vec3(1.0));
    vec3 ambient = vec3(0.0), directed = vec3(0.0), direction = vec3(0.0);
    float total = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 step = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        ivec3 at = cell + step;
        if (any(greaterThanEqual(at, rtFrame.gridCounts)))
            continue;
        vec3 axisWeights = mix(1.0 - f, f, vec3(step));
        RtGridCell sampled = GridTable(rtFrame.grid).at[at.x + rtFrame.gridCounts.x * (at.y + rtFrame.gridCounts.y * at.z)];
        float weight = axisWeights.x * axisWeights.y * axisWeights.z * float(sampled.valid);
        ambient += sampled.ambient * weight;
        directed += sampled.directed * weight;
        direction += sampled.direction * weight;
        total += weight;
    }
    if (total <= 0.0)
        return vec3(0.0);
    float size2 = dot(direction, direction);
    float facing = size2 > 0.0 ? max(0.0, dot(normal, direction) * inversesqrt(size2)) : 0.0;
    return (ambient + directed * facing) / total;
}

#endif
