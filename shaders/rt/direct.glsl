// Direct illumination of one pixel: L, the factor that replaces baked light (1.0 = irradiance 63.75 luxel units); what
// is sampled and what is not apart, for denoisers. For all lights, and for any number of choices but one, which takes
// the stages rt/choose.comp and rt/shadows.glsl.
#ifndef Q3RT_RT_DIRECT_GLSL
#define Q3RT_RT_DIRECT_GLSL
#include "rt/direct_light.glsl"
#include "rt/shadow.glsl"
#include "rt/work.glsl"

// Every light with its own shadow ray: rt_numRandomDL 0.
vec3 sumAllLights(ShadingPoint point, uvec4 key)
{
    RtLightRow row = lightRowOf(point.origin, point.normal);
    vec3 sum = vec3(0.0);
    countWork(kWorkLight, row.count + rtFrame.lightCount);
    for (uint i = 0u; i < row.count; ++i) {
        uint light = loadLightEntry(rtFrame.lightEntries, row.first + i).light;
        LightSample lit = sampleRowLight(light, point, sampleNumbers(key, kDimensionLight + light).xy);
        sum += shadowed(point.origin, lit);
    }
    uint dimension = kDimensionLight + rtFrame.triangleLightCount + rtFrame.pointLightCount;
    for (uint i = 0u; i < rtFrame.lightCount; ++i) {
        RtLight light = LightTable(rtFrame.lights).at[i];
        LightSample lit = sampleOther(light, point, sampleNumbers(key, dimension + i).xy, row.seesSky != 0u);
        sum += shadowed(point.origin, lit);
    }
    return sum;
}

vec3 sampleLights(RtPixel pixel, float sunSeen, uvec4 key)
{
    vec3 irradiance = vec3(0.0);
    for (uint n = 0u; n < rtFrame.lightsPerPixel; ++n) {
        LightSample lit = chooseLight(pixel, sunSeen, sampleBits(key, kDimensionChoice + n));
        irradiance += shadowed(sideToward(pixel, lit.direction).origin, lit);
    }
    return irradiance / float(rtFrame.lightsPerPixel);
}

void directPixel(uvec2 pixelPosition)
{
    uint index = pixelIndex(pixelPosition);
    RtPixel pixel = loadPixel(rtFrame.pixels, index);
    vec3 light = vec3(1.0), ambient = vec3(0.0);
    if (isLit(pixel)) {
        vec3 irradiance = vec3(0.0);
        GridSample grid = gridAt(pixel);
        if (rtFrame.lightsPerPixel == 0u) {
            for (uint side = 0u; side < sideCount(pixel); ++side)
                irradiance += sumAllLights(sideOf(pixel, side > 0u), ownRandomKey(pixel));
        } else {
            irradiance = sampleLights(pixel, grid.sunSeen, ownRandomKey(pixel));
        }
        light = irradiance / kWhiteIrradiance;
        ambient = ambientLight(pixel, grid);
    }
    ColorTable(rtFrame.irradiance).at[index] = vec4(light, 1.0);
    ColorTable(rtFrame.ambientL).at[index] = vec4(ambient, 1.0);
    reportRays(pixelPosition);
}

#endif
