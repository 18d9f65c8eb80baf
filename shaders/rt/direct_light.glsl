// Light of a lit pixel: of the grid, and one light chosen among all that the point may see, in proportion to what it
// would give without a shadow. The expected value is the sum over all lights, whatever the number of choices.
#ifndef Q3RT_RT_DIRECT_LIGHT_GLSL
#define Q3RT_RT_DIRECT_LIGHT_GLSL
#include "rt/grid.glsl"
#include "rt/lights.glsl"
#include "rt/sampler.glsl"

const float kLeastSunChance = 0.0625;

bool isLit(RtPixel pixel) { return pixel.lit != 0u && (rtFrame.flags & kFrameIllumination) != 0u; }

// What shows both its sides is thin: light that falls on either shows on both, as the map compilers count it.
uint sideCount(RtPixel pixel) { return (pixel.lit & kLitThin) != 0u ? 2u : 1u; }

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

// The side that a chosen light shines on: each gives light only to the side whose normal it stands above.
ShadingPoint sideToward(RtPixel pixel, vec3 direction)
{
    return sideOf(pixel, sideCount(pixel) > 1u && dot(pixel.normal, direction) < 0.0);
}

GridSample gridAt(RtPixel pixel) { return sampleGrid(sideOf(pixel, false).origin, pixel.normal, pixel.lit); }

// L of the light grid.
vec3 ambientLight(RtPixel pixel, GridSample grid)
{
    vec3 ambient = grid.irradiance * rtFrame.ambient / kWhiteIrradiance;
    if ((pixel.lit & kLitModel) != 0u)
        ambient += kModelLeastLight / rtFrame.lightScale;
    return ambient;
}

// Candidates are some lights of the row, drawn by its own probabilities from one number in equal steps, and all lights
// that are in no row. Each candidate by itself is distributed as the row says. One place serves them all, each on its
// own light.
LightChoice considerLights(LightChoice choice, ShadingPoint point, float sunChance, uvec4 bits)
{
    RtLightRow row = lightRowOf(point.origin, point.normal);
    vec4 random = unitFloats(bits);
    uint count = row.facing > 0u ? rtFrame.candidatesPerChoice : 0u;
    uint step = 0xffffffffu / rtFrame.candidatesPerChoice;
    for (uint i = 0u; i < count; ++i) {
        DrawnLight drawn = drawLight(row, bits.w + i * step);
        LightSample lit = sampleRowLight(drawn.light, point, random.xy);
        lit.light = drawn.light;
        lit.irradiance *= drawn.weight / float(count);
        choice = considerWeighted(choice, lit, lightWeight(lit.irradiance) * drawn.seen);
    }
    uint first = rtFrame.triangleLightCount + rtFrame.pointLightCount;
    for (uint i = 0u; i < rtFrame.lightCount; ++i) {
        LightSample lit = sampleOther(LightTable(rtFrame.lights).at[i], point, softShadows(), random.xy,
                                      row.seesSky != 0u);
        lit.light = first + i;
        choice = considerWeighted(choice, lit, lightWeight(lit.irradiance) * (lit.fromSky ? sunChance : 1.0));
    }
    return choice;
}

// One light of all that shine on the pixel's sides, divided by its probability. Where the grid saw no sun a thin chance
// stays: its cells are coarse.
LightSample chooseLight(RtPixel pixel, float sunSeen, uvec4 bits)
{
    LightChoice choice = beginChoice(unitFloat(bits.z));
    for (uint side = 0u; side < sideCount(pixel); ++side)
        choice = considerLights(choice, sideOf(pixel, side > 0u), max(sunSeen, kLeastSunChance), bits);
    return chosenSample(choice);
}

#endif
