// What a ray has hit: a sky?
#ifndef Q3RT_RT_SKY_HIT_GLSL
#define Q3RT_RT_SKY_HIT_GLSL
#include "rt/scene.glsl"

bool isSky(Hit hit)
{
    if (hit.t == 0.0)
        return false;
    uint surface = findTriangle(hit.instance, hit.triangle).surface;
    return (SurfaceTable(rtFrame.surfaces).at[surface].flags & kSurfaceSky) != 0u;
}

#endif
