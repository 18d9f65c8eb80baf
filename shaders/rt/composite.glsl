// Composite: radiance = A x L + B, and the picture made of it. The engine clamps baked light to what shows a texture at
// its own brightness before it multiplies; the same clamp is put on the exposed light here, so that bright places keep
// their texture. The visibility floor is a floor of that light too: it lifts what is lit, and no glow.
#ifndef Q3RT_RT_COMPOSITE_GLSL
#define Q3RT_RT_COMPOSITE_GLSL
#include "lib/tonemap.glsl"
#include "rt/scene.glsl"
#include "shared/rt_exposure.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ExposureTable { RtExposure value; };

struct Composed {
    vec3 albedo;
    vec3 lit; // A x L
    vec3 radiance;
};

// `lighting`: vec4[], direct light.
Composed composePixel(uint index, uvec2 lighting)
{
    RtPixel pixel = loadPixel(rtFrame.pixels, index);
    vec3 light = ColorTable(lighting).at[index].rgb + ColorTable(rtFrame.ambientL).at[index].rgb;
    // What is no number must not get into a mean.
    if (any(isnan(light)) || any(isinf(light)))
        light = vec3(0.0);
    vec3 lit = pixel.albedo * (light * rtFrame.lightScale);
    return Composed(pixel.albedo, lit, lit + pixel.emission);
}

float exposureFactor()
{
    float stops = rtFrame.autoExposure != uvec2(0u) ? ExposureTable(rtFrame.autoExposure).value.stops : 0.0;
    return rtFrame.exposure * exp2(stops);
}

vec3 exposePicture(Composed composed)
{
    float exposure = exposureFactor();
    vec3 a = composed.albedo;
    vec3 light = exposure * vec3(a.x > 0.0 ? composed.lit.x / a.x : 0.0, a.y > 0.0 ? composed.lit.y / a.y : 0.0,
                                 a.z > 0.0 ? composed.lit.z / a.z : 0.0);
    light = max(light, vec3(rtFrame.leastLight));
    if ((rtFrame.flags & kFrameClampLight) != 0u)
        light = clampKeepingHue(light);
    return a * light + exposure * (composed.radiance - composed.lit);
}

#endif
