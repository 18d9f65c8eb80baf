// Rays that must end on a sky.
#ifndef Q3RT_RT_SKY_RAY_GLSL
#define Q3RT_RT_SKY_RAY_GLSL
#include "rt/scene.glsl"

bool reachesSky(vec3 origin, vec3 direction)
{
    Hit hit = traceClosest(origin, direction, 1.0, kMaskShadow);
    if (hit.t == 0.0)
        return false;
    uint surface = findTriangle(hit.instance, hit.triangle).surface;
    return (SurfaceTable(rtFrame.surfaces).at[surface].flags & kSurfaceSky) != 0u;
}

#endif
