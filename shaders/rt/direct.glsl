// Direct illumination of one pixel: L, the factor that replaces baked light (1.0 = irradiance 63.75 luxel units); what
// is sampled and what is not apart, for denoisers. For all lights, and for any number of choices but one, which takes
// the stages rt/choose.comp and rt/shadows.glsl.
#ifndef Q3RT_RT_DIRECT_GLSL
#define Q3RT_RT_DIRECT_GLSL
#include "rt/direct_light.glsl"
#include "rt/shadow.glsl"
#include "rt/work.glsl"

// Light number i of a row, or of those in no row after them.
LightSample sampleNth(RtLightRow row, uint i, ShadingPoint point, uvec4 key)
{
    if (i < row.count) {
        uint light = loadLightEntry(rtFrame.lightEntries, row.first + i).light;
        return sampleRowLight(light, point, sampleNumbers(key, kDimensionLight + light).xy);
    }
    uint other = i - row.count;
    uint number = rtFrame.triangleLightCount + rtFrame.pointLightCount + other;
    return sampleOther(LightTable(rtFrame.lights).at[other], point, softShadows(),
                       sampleNumbers(key, kDimensionLight + number).xy, row.seesSky != 0u);
}

// Every light with its own shadow ray: rt_numRandomDL 0. The pixel is read anew for each: what is not carried through
// the search leaves its registers to more rays.
vec3 sumAllLights(uint index, bool behind)
{
    ShadingPoint first = sideOf(loadPixel(rtFrame.pixels, index), behind);
    RtLightRow row = lightRowOf(first.origin, first.normal);
    uint count = row.count + rtFrame.lightCount;
    countWork(kWorkLight, count);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < count; ++i) {
        // The sum is never negative; a compiler does not know, and reads again.
        RtPixel pixel = loadPixel(rtFrame.pixels, sum.x < 0.0 ? 0u : index);
        ShadingPoint point = sideOf(pixel, behind);
        sum += shadowed(point.origin, sampleNth(row, i, point, ownRandomKey(pixel)));
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
                irradiance += sumAllLights(index, side > 0u);
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
