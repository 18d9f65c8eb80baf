// The sky in a direction: box, then cloud stages, as the engine draws them (the sky is infinitely far: no parallax).
#ifndef Q3RT_RT_SKY_GLSL
#define Q3RT_RT_SKY_GLSL
#include "rt/material.glsl"
#include "rt/work.glsl"

struct SkyFace {
    uint side; // 0..5: rt lf bk ft up dn
    vec2 st;   // picture coordinates, t down
};

// Face and coordinates on it of a direction: table of the engine's sky box, s to the right and t up in [-1, 1].
SkyFace findSkyFace(vec3 d)
{
    vec3 a = abs(d);
    SkyFace face;
    vec2 st;
    if (a.x > a.y && a.x > a.z) {
        face.side = d.x > 0.0 ? 0u : 1u;
        st = vec2(d.x > 0.0 ? -d.y : d.y, d.z) / a.x;
    } else if (a.y > a.z && a.y > a.x) {
        face.side = d.y > 0.0 ? 2u : 3u;
        st = vec2(d.y > 0.0 ? d.x : -d.x, d.z) / a.y;
    } else {
        face.side = d.z > 0.0 ? 4u : 5u;
        st = vec2(-d.y, d.z > 0.0 ? -d.x : d.x) / a.z;
    }
    face.st = vec2(st.x + 1.0, 1.0 - st.y) * 0.5;
    return face;
}

// Cloud coordinates: where the direction meets a sphere of radius R + height around a point R below the eye; the
// coordinates are the angles of that point from the x and y axes, in radians. R = 4096 qu.
vec2 cloudCoordinates(vec3 d, float height)
{
    const float radius = 4096.0;
    float b = d.z * radius;
    float p = -b + sqrt(b * b + 2.0 * radius * height + height * height);
    vec3 q = normalize(d * p + vec3(0.0, 0.0, radius));
    return vec2(acos(clamp(q.x, -1.0, 1.0)), acos(clamp(q.y, -1.0, 1.0)));
}

// Clouds cover all faces but the lowest.
const uint kSkyFaceBelow = 5u;

VertexIn cloudVertex(vec3 direction, float height)
{
    return VertexIn(direction, vec3(0.0), cloudCoordinates(direction, height), vec2(0.0), vec4(1.0));
}

// Unit directions of the pixel and of its neighbours.
vec3 skyColor(RtSky sky, vec3 direction, vec3 directionX, vec3 directionY)
{
    countWork(kWorkSky);
    SkyFace face = findSkyFace(direction);
    vec3 color = vec3(0.0);
    if (sky.hasBox != 0u) {
        SkyFace faceX = findSkyFace(directionX), faceY = findSkyFace(directionY);
        vec2 stX = faceX.side == face.side ? faceX.st - face.st : vec2(0.0);
        vec2 stY = faceY.side == face.side ? faceY.st - face.st : vec2(0.0);
        color = shadingColor(textureGrad(textures[nonuniformEXT(sky.box[face.side])], face.st, stX, stY).rgb);
    }
    if (sky.stageCount == 0u || face.side == kSkyFaceBelow)
        return color;
    EntityIn none = EntityIn(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), rtFrame.eye);
    AffineColor clouds =
        addStages(beginAffine(), sky.firstStage, sky.stageCount, cloudVertex(direction, sky.cloudHeightQu),
                  cloudVertex(directionX, sky.cloudHeightQu), cloudVertex(directionY, sky.cloudHeightQu), none, 0.0,
                  false);
    return resolveAffine(clouds, vec3(1.0), color);
}

#endif
