// Direct illumination of one pixel: L, the factor that replaces baked light (1.0 = irradiance 63.75 luxel units); what
// is sampled and what is not apart, for denoisers.
// One light is chosen among all that the point may see, in proportion to what it would give without a shadow; its
// shadow ray decides. The expected value is the sum over all lights, whatever the number of choices.
#ifndef Q3RT_RT_DIRECT_GLSL
#define Q3RT_RT_DIRECT_GLSL
#include "rt/grid.glsl"
#include "rt/lights.glsl"

const float kLeastSkyChance = 0.0625;

vec3 shadowed(ShadingPoint point, vec3 irradiance, vec3 direction)
{
    if (lightWeight(irradiance) <= 0.0)
        return vec3(0.0);
    return traceVisible(point.origin, direction, 1.0, kMaskShadow) ? irradiance : vec3(0.0);
}

// Every light with its own shadow ray: rt_numRandomDL 0.
vec3 sumAllLights(ShadingPoint point, RtLightRow row, uvec4 key)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < row.count; ++i) {
        uint light = NumberTable(rtFrame.lightIndices).at[row.first + i];
        LightSample lit = sampleTriangle(light, point, randomNumbers(key, kDimensionLight + light).xy);
        sum += shadowed(point, lit.irradiance, lit.direction);
    }
    for (uint i = 0u; i < rtFrame.lightCount; ++i) {
        vec2 random = randomNumbers(key, kDimensionLight + rtFrame.triangleLightCount + i).xy;
        LightSample lit = sampleOther(i, point, random, row.seesSky != 0u);
        sum += shadowed(point, lit.irradiance, lit.direction);
    }
    return sum;
}

// Candidates are all lights of a short row; of a long one, a random light out of each of `candidates` equal shares.
LightChoice chooseLight(ShadingPoint point, RtLightRow row, float skySeen, uvec4 key, uint choiceNumber)
{
    LightChoice choice = emptyChoice();
    uint candidates = min(row.count, rtFrame.candidatesPerChoice);
    uint dimension = kDimensionLight + choiceNumber * (rtFrame.triangleLightCount + rtFrame.lightCount);
    float share = candidates > 0u ? float(row.count) / float(candidates) : 0.0;
    for (uint i = 0u; i < candidates; ++i) {
        vec4 random = randomNumbers(key, dimension + i);
        uint first = uint(float(i) * share);
        uint end = i + 1u == candidates ? row.count : uint(float(i + 1u) * share);
        uint inShare = min(uint(random.w * float(end - first)), end - first - 1u);
        uint light = NumberTable(rtFrame.lightIndices).at[row.first + first + inShare];
        LightSample lit = sampleTriangle(light, point, random.xy);
        lit.irradiance *= float(end - first);
        choice = considerLight(choice, lit, random.z);
    }
    for (uint i = 0u; i < rtFrame.lightCount; ++i) {
        vec4 random = randomNumbers(key, dimension + rtFrame.triangleLightCount + i);
        LightSample lit = sampleOther(i, point, random.xy, row.seesSky != 0u);
        bool fromSky = LightTable(rtFrame.lights).at[i].kind != kLightSphere;
        choice = considerWeighted(choice, lit, lightWeight(lit.irradiance) * (fromSky ? skySeen : 1.0), random.z);
    }
    return choice;
}

void directPixel(uvec2 pixelPosition)
{
    uint index = pixelIndex(pixelPosition);
    RtPixel pixel = PixelTable(rtFrame.pixels).at[index];
    vec3 light = vec3(1.0), ambient = vec3(0.0);
    if (pixel.lit != 0u && (rtFrame.flags & kFrameIllumination) != 0u) {
        ShadingPoint point;
        point.position = pixel.position;
        point.error = pixel.error;
        point.origin = offsetOrigin(pixel.position, pixel.error, pixel.geometricNormal);
        point.normal = pixel.normal;
        RtLightRow row = LightRowTable(rtFrame.lightRows).at[lightRowOf(point.origin)];
        uvec4 key = ownRandomKey(pixel);
        GridSample grid = sampleGrid(point.origin, point.normal);
        // Where the grid saw no sky a thin chance stays: its cells are coarse.
        float skySeen = max(grid.skySeen, kLeastSkyChance);
        vec3 irradiance = vec3(0.0);
        if (rtFrame.lightsPerPixel == 0u) {
            irradiance = sumAllLights(point, row, key);
        } else {
            for (uint n = 0u; n < rtFrame.lightsPerPixel; ++n) {
                LightChoice choice = chooseLight(point, row, skySeen, key, n);
                irradiance += shadowed(point, chosenIrradiance(choice), choice.direction);
            }
            irradiance /= float(rtFrame.lightsPerPixel);
        }
        light = irradiance / kWhiteIrradiance;
        ambient = grid.irradiance * rtFrame.ambient / kWhiteIrradiance;
    }
    ColorTable(rtFrame.irradiance).at[index] = vec4(light, 1.0);
    ColorTable(rtFrame.ambientL).at[index] = vec4(ambient, 1.0);
}

#endif
