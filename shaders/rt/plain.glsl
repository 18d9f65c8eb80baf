// Plain shading of one pixel: the closest solid, white and opaque whatever it is made of, in the light of one ray
// toward one of the map's lights. Two searches and what they ask for: what tracing costs by itself. Pixels of a block
// take the same light: their rays go the same way.
#ifndef Q3RT_RT_PLAIN_GLSL
#define Q3RT_RT_PLAIN_GLSL
#include "lib/ray.glsl"
#include "lib/tonemap.glsl"
#include "rt/shadow.glsl"
#include "rt/surface.glsl"

ShadingPoint findPlainPoint(Hit hit, vec3 direction)
{
    SceneTriangle triangle = findTriangle(hit.instance, hit.triangle);
    vec3 corner0 = loadVertexPosition(triangle.vertices, triangle.vertex.x);
    vec3 corner1 = loadVertexPosition(triangle.vertices, triangle.vertex.y);
    vec3 corner2 = loadVertexPosition(triangle.vertices, triangle.vertex.z);
    HitPoint at = makeHitPoint(corner0, corner1, corner2, hit.barycentric);
    vec3 normal = cross(corner2 - corner0, corner1 - corner0);
    if (triangle.entity != 0u) {
        RtEntity entity = EntityTable(rtFrame.entities).at[triangle.entity];
        at = transformHitPoint(entity.worldFromModel[0], entity.worldFromModel[1], entity.worldFromModel[2], at,
                               rtFrame.inverseError);
        normal = normalToWorld(entity, normal);
    }
    ShadingPoint point;
    point.position = at.position;
    point.error = at.error;
    point.normal = unitOr(dot(normal, direction) < 0.0 ? normal : -normal, -direction);
    point.origin = offsetOrigin(at.position, at.error, point.normal);
    return point;
}

const uint kPlainBlock = 8u; // pixels a side
const uint kPlainDrawn = 4u; // lights of the rows

// Candidates: some lights of the rows and one of those in none. A light's number goes on behind the rows' lights.
const uint kPlainCandidates = kPlainDrawn + 1u;

uint rowLightCount() { return rtFrame.triangleLightCount + rtFrame.pointLightCount; }

DrawnLight plainCandidate(RtLightRow row, uint bits, uint i)
{
    if (i < kPlainDrawn) {
        DrawnLight drawn = drawLight(row, bits + i * (0xffffffffu / kPlainDrawn));
        return DrawnLight(drawn.light, drawn.weight / float(kPlainDrawn), drawn.seen);
    }
    uint other, rest;
    umulExtended(bits, rtFrame.lightCount, other, rest);
    return DrawnLight(rowLightCount() + other, float(rtFrame.lightCount), 1.0);
}

// A light that is not a triangle.
RtLight plainRound(uint light)
{
    if (light < rowLightCount())
        return pointLight(light);
    return LightTable(rtFrame.lights).at[light - rowLightCount()];
}

bool plainMayShine(uint light, ShadingPoint point)
{
    return light < rtFrame.triangleLightCount ? mayShine(light, point) : otherMayShine(plainRound(light), point);
}

// By the cheapest way: a triangle's point uniform by area, of a sphere or sun its middle.
LightSample samplePlain(uint light, ShadingPoint point, vec2 random, bool seesSky)
{
    if (light < rtFrame.triangleLightCount)
        return sampleTriangleByArea(loadTriangleLight(rtFrame.triangleLights, light), point, random);
    return sampleOther(plainRound(light), point, false, random, seesSky);
}

// Any of some lights that may shine here, wherever they are, as if it alone gave the light of all: few pixels that some
// light faces have no ray.
LightSample drawPlainLight(ShadingPoint point, uvec4 bits)
{
    RtLightRow row = everyLight();
    uint first = row.facing > 0u ? 0u : kPlainDrawn, end = rtFrame.lightCount > 0u ? kPlainCandidates : kPlainDrawn;
    uint shining = 0u; // a bit each
    for (uint i = first; i < end; ++i)
        shining |= plainMayShine(plainCandidate(row, bits.w, i).light, point) ? 1u << i : 0u;
    if (shining == 0u)
        return darkSample(point.normal);
    uint count = uint(bitCount(shining)), nth, rest;
    umulExtended(bits.z, count, nth, rest);
    for (; nth > 0u; --nth)
        shining &= shining - 1u;
    DrawnLight drawn = plainCandidate(row, bits.w, uint(findLSB(shining)));
    LightSample lit = samplePlain(drawn.light, point, unitFloats(bits).xy, row.seesSky != 0u);
    lit.irradiance *= drawn.weight * float(count);
    return lit;
}

void plainPixel(uvec2 pixelPosition)
{
    vec3 direction = cameraDirection(rtFrame.forward, rtFrame.left, rtFrame.up,
                                     (vec2(pixelPosition) + 0.5) / vec2(rtFrame.size));
    countRay();
    Hit hit = traceSight(rtFrame.eye, direction, 0.0, rtFrame.farQu, kMaskSolid, 0u, LayerKey(0.0, 0u, 0u)).solid;
    vec3 light = vec3(0.0);
    if (hit.t > 0.0) {
        ShadingPoint point = findPlainPoint(hit, direction);
        LightSample lit = drawPlainLight(point, randomBits(randomKey(pixelPosition / kPlainBlock), kDimensionChoice));
        light = shadowed(point.origin, lit) / kWhiteIrradiance;
    }
    vec3 shown = clampKeepingHue(light * (rtFrame.lightScale * rtFrame.exposure));
    ColorTable(rtFrame.picture).at[pixelIndex(pixelPosition)] = vec4(shown, 1.0);
    reportRays(pixelPosition);
}

#endif
