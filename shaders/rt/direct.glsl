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
        uint light = LightEntryTable(rtFrame.lightEntries).at[row.first + i].light;
        LightSample lit = sampleRowLight(light, point, randomNumbers(key, kDimensionLight + light).xy);
        sum += shadowed(point, lit.irradiance, lit.direction);
    }
    uint dimension = kDimensionLight + rtFrame.triangleLightCount + rtFrame.pointLightCount;
    for (uint i = 0u; i < rtFrame.lightCount; ++i) {
        RtLight light = LightTable(rtFrame.lights).at[i];
        LightSample lit = sampleOther(light, point, randomNumbers(key, dimension + i).xy, row.seesSky != 0u);
        sum += shadowed(point, lit.irradiance, lit.direction);
    }
    return sum;
}

// Candidates are some lights of the row, drawn by its own probabilities from one random number in equal steps, and all
// lights that are in no row. Each candidate by itself is distributed as the row says.
LightChoice chooseLight(ShadingPoint point, RtLightRow row, float skySeen, uvec4 key, uint choiceNumber)
{
    LightChoice choice = emptyChoice();
    uint count = row.facing > 0u ? rtFrame.candidatesPerChoice : 0u;
    uint dimension = kDimensionLight + choiceNumber * (rtFrame.candidatesPerChoice + rtFrame.lightCount);
    uint start = randomBits(key, dimension).w;
    uint step = 0xffffffffu / rtFrame.candidatesPerChoice;
    for (uint i = 0u; i < count; ++i) {
        vec4 random = randomNumbers(key, dimension + i);
        DrawnLight drawn = drawLight(row, start + i * step);
        LightSample lit = sampleRowLight(drawn.light, point, random.xy);
        lit.irradiance *= drawn.weight / float(count);
        choice = considerLight(choice, lit, random.z);
    }
    dimension += rtFrame.candidatesPerChoice;
    for (uint i = 0u; i < rtFrame.lightCount; ++i) {
        vec4 random = randomNumbers(key, dimension + i);
        RtLight light = LightTable(rtFrame.lights).at[i];
        LightSample lit = sampleOther(light, point, random.xy, row.seesSky != 0u);
        bool fromSky = light.kind != kLightSphere;
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
        RtLightRow row = lightRowOf(point.origin, point.normal);
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
