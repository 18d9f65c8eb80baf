// Whether a light shines on a point: one ray.
#ifndef Q3RT_RT_SHADOW_GLSL
#define Q3RT_RT_SHADOW_GLSL
#include "rt/lights.glsl"
#include "rt/sky_hit.glsl"
#include "rt/work.glsl"

// Is the way free as far as t = 1? Skies stop light as walls do, but for the light that comes from them.
bool isOpen(vec3 origin, vec3 direction, bool fromSky)
{
    countRay();
    // One search for both kinds: two would be waited for one after the other where neighbours differ.
    Hit hit = traceSolid(origin, direction, 1.0, kMaskShadow, fromSky);
    return fromSky ? isSky(hit) : hit.t == 0.0;
}

vec3 shadowed(vec3 origin, LightSample lit)
{
    return lightWeight(lit.irradiance) > 0.0 && isOpen(origin, lit.direction, lit.fromSky) ? lit.irradiance : vec3(0.0);
}

#endif
