// Direct illumination of one pixel: L, the factor that replaces baked light (1.0 = irradiance 63.75 luxel units); what
// is sampled and what is not apart, for denoisers.
// One light is chosen among all that the point may see, in proportion to what it would give without a shadow; its
// shadow ray decides. The expected value is the sum over all lights, whatever the number of choices.
#ifndef Q3RT_RT_DIRECT_GLSL
#define Q3RT_RT_DIRECT_GLSL
#include "rt/grid.glsl"
#include "rt/lights.glsl"
#include "rt/sampler.glsl"
#include "rt/shadow.glsl"
#include "rt/work.glsl"

const float kLeastSunChance = 0.0625;

// Every light with its own shadow ray: rt_numRandomDL 0.
vec3 sumAllLights(ShadingPoint point, RtLightRow row, uvec4 key)
{
    vec3 sum = vec3(0.0);
    countWork(kWorkLight, row.count + rtFrame.lightCount);
    for (uint i = 0u; i < row.count; ++i) {
        uint light = LightEntryTable(rtFrame.lightEntries).at[row.first + i].light;
        LightSample lit = sampleRowLight(light, point, sampleNumbers(key, kDimensionLight + light).xy);
        sum += shadowed(point, lit);
    }
    uint dimension = kDimensionLight + rtFrame.triangleLightCount + rtFrame.pointLightCount;
    for (uint i = 0u; i < rtFrame.lightCount; ++i) {
        RtLight light = LightTable(rtFrame.lights).at[i];
        LightSample lit = sampleOther(light, point, sampleNumbers(key, dimension + i).xy, row.seesSky != 0u);
        sum += shadowed(point, lit);
    }
    return sum;
}

// Candidates are some lights of the row, drawn by its own probabilities from one number in equal steps, and all lights
// that are in no row. Each candidate by itself is distributed as the row says. One place serves them all, each on its
// own light; one number chooses among them.
LightChoice chooseLight(ShadingPoint point, RtLightRow row, float sunSeen, uvec4 bits)
{
    vec4 random = unitFloats(bits);
    LightChoice choice = beginChoice(random.z);
    uint count = row.facing > 0u ? rtFrame.candidatesPerChoice : 0u;
    uint step = 0xffffffffu / rtFrame.candidatesPerChoice;
    for (uint i = 0u; i < count; ++i) {
        DrawnLight drawn = drawLight(row, bits.w + i * step);
        LightSample lit = sampleRowLight(drawn.light, point, random.xy);
        lit.irradiance *= drawn.weight / float(count);
        choice = considerLight(choice, lit);
    }
    for (uint i = 0u; i < rtFrame.lightCount; ++i) {
        LightSample lit = sampleOther(LightTable(rtFrame.lights).at[i], point, random.xy, row.seesSky != 0u);
        choice = considerWeighted(choice, lit, lightWeight(lit.irradiance) * (lit.fromSky ? sunSeen : 1.0));
    }
    return choice;
}

// One side of a lit pixel's surface, as a point that shadow rays leave.
ShadingPoint sideOf(RtPixel pixel, bool behind)
{
    float side = behind ? -1.0 : 1.0;
    ShadingPoint point;
    point.position = pixel.position;
    point.error = pixel.error;
    point.origin = offsetOrigin(pixel.position, pixel.error, pixel.geometricNormal * side);
    point.normal = pixel.normal * side;
    return point;
}

// Traced irradiance of one side. Where the grid saw no sun a thin chance stays: its cells are coarse.
vec3 sampleLights(ShadingPoint point, float sunSeen, uvec4 key)
{
    RtLightRow row = lightRowOf(point.origin, point.normal);
    if (rtFrame.lightsPerPixel == 0u)
        return sumAllLights(point, row, key);
    vec3 irradiance = vec3(0.0);
    for (uint n = 0u; n < rtFrame.lightsPerPixel; ++n) {
        LightChoice choice =
            chooseLight(point, row, max(sunSeen, kLeastSunChance), sampleBits(key, kDimensionChoice + n));
        irradiance += shadowed(point, chosenSample(choice));
    }
    return irradiance / float(rtFrame.lightsPerPixel);
}

// What shows both its sides is thin: light that falls on either shows on both, as the map compilers count it.
void directPixel(uvec2 pixelPosition)
{
    uint index = pixelIndex(pixelPosition);
    RtPixel pixel = PixelTable(rtFrame.pixels).at[index];
    vec3 light = vec3(1.0), ambient = vec3(0.0);
    if (pixel.lit != 0u && (rtFrame.flags & kFrameIllumination) != 0u) {
        bool thin = (pixel.lit & kLitThin) != 0u;
        vec3 irradiance = vec3(0.0);
        GridSample grid = sampleGrid(sideOf(pixel, false).origin, pixel.normal, pixel.lit);
        for (uint side = 0u; side < (thin ? 2u : 1u); ++side)
            irradiance += sampleLights(sideOf(pixel, side > 0u), grid.sunSeen, ownRandomKey(pixel));
        light = irradiance / kWhiteIrradiance;
        ambient = grid.irradiance * rtFrame.ambient / kWhiteIrradiance;
        if ((pixel.lit & kLitModel) != 0u)
            ambient += kModelLeastLight / rtFrame.lightScale;
    }
    ColorTable(rtFrame.irradiance).at[index] = vec4(light, 1.0);
    ColorTable(rtFrame.ambientL).at[index] = vec4(ambient, 1.0);
    reportRays(pixelPosition);
}

#endif
