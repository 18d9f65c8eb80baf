// Whether a light shines on a point: one ray.
#ifndef Q3RT_RT_SHADOW_GLSL
#define Q3RT_RT_SHADOW_GLSL
#include "rt/lights.glsl"
#include "rt/sky_hit.glsl"
#include "rt/work.glsl"

// Skies stop light as walls do, but for the light that comes from them.
vec3 shadowed(ShadingPoint point, LightSample lit)
{
    if (lightWeight(lit.irradiance) <= 0.0)
        return vec3(0.0);
    countRay();
    // One search for both kinds: two would be waited for one after the other where neighbours differ.
    Hit hit = traceSolid(point.origin, lit.direction, 1.0, kMaskShadow, lit.fromSky);
    bool open = lit.fromSky ? isSky(hit) : hit.t == 0.0;
    return open ? lit.irradiance : vec3(0.0);
}

#endif
