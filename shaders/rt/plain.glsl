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

// Any of some lights that may shine here, wherever they are, as if it alone gave the light of all: few pixels that some
// light faces have no ray.
LightSample drawPlainLight(ShadingPoint point, uvec4 bits)
{
    RtLightRow row = everyLight();
    uint drawnCount = row.facing > 0u ? kPlainDrawn : 0u;
    uint step = 0xffffffffu / kPlainDrawn;
    LightChoice choice = beginChoice(unitFloat(bits.z));
    LightSample candidate = darkSample(point.normal);
    for (uint i = 0u; i < drawnCount + rtFrame.lightCount; ++i) {
        bool shines = i < drawnCount ? mayShine(drawLight(row, bits.w + i * step).light, point)
                                     : otherMayShine(LightTable(rtFrame.lights).at[i - drawnCount], point);
        candidate.light = i;
        choice = considerWeighted(choice, candidate, shines ? 1.0 : 0.0);
    }
    if (choice.weightSum == 0.0)
        return candidate;
    uint chosen = choice.kept.light;
    vec2 random = unitFloats(bits).xy;
    LightSample lit;
    if (chosen < drawnCount) {
        DrawnLight drawn = drawLight(row, bits.w + chosen * step);
        lit = sampleRowLight(drawn.light, point, random);
        lit.irradiance *= drawn.weight / float(drawnCount);
    } else {
        lit = sampleOther(LightTable(rtFrame.lights).at[chosen - drawnCount], point, random, row.seesSky != 0u);
    }
    lit.irradiance *= choice.weightSum;
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
