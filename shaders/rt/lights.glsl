// The light table: which lights a point may see, and one sample of each. Above it stands only the choice.
#ifndef Q3RT_RT_LIGHTS_GLSL
#define Q3RT_RT_LIGHTS_GLSL
#include "lib/light.glsl"
#include "lib/light_row.glsl"
#include "lib/offset.glsl"
#include "lib/random.glsl"
#include "rt/rows.glsl"
#include "rt/scene.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LightColorTable { vec3 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LightTable { RtLight at[]; };

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer NodeStartTable { int at[]; };

// Dimensions of a pixel's numbers. A choice takes kDimensionChoice + its number (rt_numRandomDL is at most 64); where
// all lights are tried each takes kDimensionLight + its number. Layers: + 256 x their number.
const uint kDimensionLens = 0u;
const uint kDimensionLayer = 2u;
const uint kDimensionChoice = 16u;
const uint kDimensionLight = 128u;

uvec4 randomKey(uvec2 pixel) { return uvec4(pixel, rtFrame.frame, rtFrame.seed); }

// A pixel's own numbers may come from an earlier frame: see rt/denoise_project.glsl.
uint packKeyPixel(uvec2 pixel) { return pixel.x | pixel.y << 16u; }
uvec4 ownRandomKey(RtPixel pixel)
{
    return uvec4(pixel.keyPixel & 0xffffu, pixel.keyPixel >> 16u, pixel.keyFrame, rtFrame.seed);
}

// Node of the map's tree, or leaf, below which a point lies.
int nodeAround(vec3 point)
{
    ivec3 cell = ivec3(floor((point - rtFrame.nodeStartOrigin) / rtFrame.nodeStartCellQu));
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, rtFrame.nodeStartCounts)))
        return 0;
    int index = cell.x + rtFrame.nodeStartCounts.x * (cell.y + rtFrame.nodeStartCounts.y * cell.z);
    return NodeStartTable(rtFrame.nodeStarts).at[index];
}

// Cluster of a point off every surface, -1 outside all. A point on a plane belongs to its back, as in the map.
int clusterOf(vec3 point)
{
    if (rtFrame.clusterCount == 0u)
        return -1;
    int node = nodeAround(point);
    while (node >= 0) {
        RtNode at = loadNode(rtFrame.nodes, uint(node));
        node = dot(at.plane.normal, point) - at.plane.distance > 0.0 ? at.front : at.back;
    }
    int cluster = -2 - node;
    return cluster < int(rtFrame.clusterCount) ? cluster : -1;
}

RtLightRow everyLight() { return loadLightRow(rtFrame.lightRows, rtFrame.clusterCount * kNormalClassCount); }

// Row of the light table for a point off every surface with a unit normal; a point outside all clusters has all lights.
RtLightRow lightRowOf(vec3 point, vec3 normal)
{
    int cluster = rtFrame.cullLights == 0u ? -1 : clusterOf(point);
    if (cluster < 0)
        return everyLight();
    uint first = uint(cluster) * kNormalClassCount;
    RtLightRow row = loadLightRow(rtFrame.lightRows, first);
    if (rtFrame.cullLights == 1u)
        return row;
    row.count = row.facing;
    uint which = normalClass(normal);
    if (which == 0u)
        return row;
    RtLightRow narrower = loadLightRow(rtFrame.lightRows, first + which);
    if (alongClass(which, point) < narrower.plane)
        return row;
    return narrower;
}

// One of a row's lights at random, and 1 / its probability. `bits`: 32 of them, the higher ones draw the column.
struct DrawnLight {
    uint light;
    float weight;
    float seen; // seenOf()
};
DrawnLight drawLight(RtLightRow row, uint bits)
{
    uint column, rest;
    umulExtended(bits, row.facing, column, rest);
    RtLightEntry entry = loadLightEntry(rtFrame.lightEntries, row.first + column);
    if (unitFloat(rest) >= chanceOf(entry))
        entry = loadLightEntry(rtFrame.lightEntries, row.first + entry.other);
    return DrawnLight(entry.light, entry.weight, seenOf(entry));
}

struct ShadingPoint {
    vec3 position;
    vec3 error; // of position, see lib/offset.glsl
    vec3 origin; // of shadow rays: clear of the surface
    vec3 normal; // unit, shading
};

// What a sample of a triangle takes from the light's own rules, and where its ray ends.
LightSample finishTriangle(LightSample result, RtTriangleLight l, ShadingPoint point)
{
    if (isTriangleFaint(point.origin, point.normal, l.corner, l.edge1, l.edge2, l.normal, l.areaQu2, l.radiance,
                        l.faintest))
        result.irradiance = vec3(0.0);
    if (l.animation != 0u)
        result.irradiance *= LightColorTable(rtFrame.lightColors).at[l.animation - 1u];
    if ((l.flags & kLightUpward) != 0u && result.direction.z <= 0.0)
        result.irradiance = vec3(0.0);
    // A point in the light's own plane takes nothing from it: with a shading normal that leans off the face, an emitter
    // would light itself through nothing but rounding.
    if (abs(dot(l.normal, point.position - l.corner)) <= l.error + dot(abs(l.normal), point.error))
        result.irradiance = vec3(0.0);
    // The ray ends in front of the light by the bounds of the sampled point's error and of the intersector's own.
    float side = dot(l.normal, result.direction) < 0.0 ? 1.0 : -1.0;
    float end = l.error + dot(abs(result.direction), vec3(kHitPointError));
    result.direction += l.normal * (side * end);
    return result;
}

LightSample sampleTriangle(RtTriangleLight l, ShadingPoint point, vec2 random)
{
    LightSample result = sampleTriangleLight(point.origin, point.normal, l.corner, l.edge1, l.edge2, l.normal,
                                             l.areaQu2, l.radiance, (l.flags & kLightTwoSided) != 0u, random.x,
                                             random.y);
    return finishTriangle(result, l, point);
}

LightSample sampleTriangleByArea(RtTriangleLight l, ShadingPoint point, vec2 random)
{
    LightSample result = sampleTriangleLightByArea(point.origin, point.normal, l.corner, l.edge1, l.edge2, l.normal,
                                                   l.areaQu2, l.radiance, (l.flags & kLightTwoSided) != 0u, random.x,
                                                   random.y);
    return finishTriangle(result, l, point);
}

// Do spheres and suns have their size, or only a middle?
bool softShadows() { return (rtFrame.flags & kFrameSoftShadows) != 0u; }

LightSample sampleSphere(RtLight l, ShadingPoint point, bool soft, vec2 random)
{
    LightSample result =
        sampleSphereLight(point.origin, point.normal, l.position, soft ? l.size : 0.0, l.power, random.x, random.y);
    if (isFaint(result.irradiance, l.faintest))
        result.irradiance = vec3(0.0);
    if (l.spot > 0.0)
        result.irradiance *= spotShare(l.axis, l.spot, -result.direction);
    return result;
}

// A light of no row; suns shine only where a sky may be seen.
LightSample sampleOther(RtLight l, ShadingPoint point, bool soft, vec2 random, bool seesSky)
{
    if (l.kind == kLightSphere)
        return sampleSphere(l, point, soft, random);
    LightSample result =
        sampleSun(point.normal, l.position, soft ? l.size : 0.0, l.power, rtFrame.farQu, random.x, random.y);
    if (!seesSky)
        result.irradiance = vec3(0.0);
    return result;
}

// Can a light give anything to a point? Cheaper than a sample; never false where one has light.
bool otherMayShine(RtLight l, ShadingPoint point)
{
    // A soft sun of angle a reaches sin(a) below the horizon: at most the square root of 2 (1 - cos a).
    return l.kind == kLightSphere ? dot(point.normal, l.position - point.origin) > -l.size
                                  : dot(point.normal, l.position) > -sqrt(2.0 * l.size);
}

RtLight pointLight(uint light) { return LightTable(rtFrame.pointLights).at[light - rtFrame.triangleLightCount]; }

bool mayShine(uint light, ShadingPoint point)
{
    if (light < rtFrame.triangleLightCount) {
        RtTriangleLight l = loadTriangleLight(rtFrame.triangleLights, light);
        return triangleMayShine(point.origin, point.normal, l.corner, l.edge1, l.edge2, l.normal,
                                (l.flags & kLightTwoSided) != 0u);
    }
    return otherMayShine(pointLight(light), point);
}

// A light by its number in the rows.
LightSample sampleRowLight(uint light, ShadingPoint point, vec2 random)
{
    if (light < rtFrame.triangleLightCount)
        return sampleTriangle(loadTriangleLight(rtFrame.triangleLights, light), point, random);
    return sampleSphere(pointLight(light), point, softShadows(), random);
}

#endif
