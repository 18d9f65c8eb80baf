// What a camera ray has gathered so far: layers from front to back, the lit point that is kept for the direct stage,
// and what the filters over frames follow.
#ifndef Q3RT_RT_PICTURE_GLSL
#define Q3RT_RT_PICTURE_GLSL
#include "rt/camera.glsl"
#include "rt/material.glsl"
#include "rt/past.glsl"

// A layer that lets less than this through hides what is behind it.
const float kHidingShare = 0.5;

// One water or glass surface along a camera ray is followed both ways: its reflection after the rest. The reflection of
// a ray that has met one, or has turned, is followed instead of the rest, by chance.
struct Reflection {
    vec3 passed; // 0: there is none
    vec3 position;
    vec3 normal;
    float t;
    vec2 onLens;
};

struct Picture {
    vec3 passed; // what the layers so far let through
    RtPixel pixel;
    float weightSum; // of the layers that take light
    vec2 at;         // where the camera ray goes through the picture, pixels
    vec2 lens;       // where it begins on the lens, unit disc
    vec2 onLens;     // the same of this part of it: the near depth range has no lens
    uint turns;      // of the ray so far
    bool reflected;  // `reflection` has been used
    Reflection reflection;
    bool followed; // there are guide and past
    RtGuide guide;
    RtPast past;
};

// Histories follow the lit layer, or else the first that hides most of what is behind it.
void followLayer(inout Picture picture, CameraRay ray, SurfacePoint point, SurfacePlace place, uint normal)
{
    if ((rtFrame.flags & kFrameHistory) == 0u)
        return;
    picture.followed = true;
    CameraRay straight = makeCameraRay(picture.at, picture.onLens);
    picture.guide.position = picture.turns == 0u ? point.hit.position : straight.origin + straight.direction * place.t;
    picture.guide.normal = normal;
    picture.past = findPast(picture.guide, place, point, straight, ray);
}

uint litKind(uint surfaceFlags)
{
    return ((surfaceFlags & kSurfaceThin) != 0u ? kLitThin : 0u) |
           ((surfaceFlags & kSurfaceModel) != 0u ? kLitModel : 0u);
}

void addLayer(inout Picture picture, CameraRay ray, SurfacePoint point, SurfacePlace place, MaterialColor color,
              float random)
{
    bool follows = false;
    uint normal = kNoNormal;
    picture.pixel.emission += picture.passed * color.glow;
    vec3 albedo = picture.passed * color.albedo;
    float weight = albedo.x + albedo.y + albedo.z;
    if (weight > 0.0) {
        picture.weightSum += weight;
        if (random * picture.weightSum < weight) {
            picture.pixel.lit = (picture.turns == 0u ? kLitStraight : kLitTurned) | litKind(point.surface.flags);
            picture.pixel.position = point.hit.position;
            picture.pixel.error = point.hit.error;
            picture.pixel.geometricNormal = point.geometricNormal;
            // A surface seen from behind is lit on the side that is seen.
            picture.pixel.normal = point.frontFace ? point.normal : -point.normal;
            picture.pixel.albedo = albedo / weight;
            picture.pixel.instance = place.instance;
            picture.pixel.triangle = place.triangle;
            picture.pixel.barycentric = packUnorm2x16(place.barycentric);
            follows = true;
            normal = packNormal(picture.pixel.normal);
        }
    }
    float through = max(color.through.x, max(color.through.y, color.through.z));
    if (follows || (!picture.followed && through < kHidingShare))
        followLayer(picture, ray, point, place, normal);
    picture.passed *= color.through;
}

Picture beginPicture(CameraPlace place, uvec2 pixelPosition)
{
    Picture picture;
    picture.at = place.at;
    picture.lens = place.lens;
    picture.onLens = place.near ? vec2(0.0) : place.lens;
    picture.passed = vec3(1.0);
    picture.weightSum = 0.0;
    picture.followed = false;
    picture.turns = 0u;
    picture.reflected = false;
    picture.reflection = Reflection(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, vec2(0.0));
    picture.pixel = RtPixel(vec3(0.0), 0u, vec3(0.0), packKeyPixel(pixelPosition), vec3(0.0, 0.0, 1.0), rtFrame.frame,
                            vec3(0.0, 0.0, 1.0), 0u, vec3(0.0), 0u, vec3(0.0), 0u);
    return picture;
}

// The sky is followed as something as far as the map is large, which does not come nearer.
void keepPlace(Picture picture, uvec2 pixelPosition)
{
    if (!picture.followed) {
        vec3 direction = makeCameraRay(picture.at, picture.onLens).direction;
        picture.guide = RtGuide(rtFrame.eye + direction * rtFrame.farQu, kNoNormal);
        picture.past = RtPast(rtFrame.previousEye + direction * rtFrame.farQu, kNoNormal);
    }
    storeGuide(rtFrame.guides, pixelIndex(pixelPosition), picture.guide);
    storePast(rtFrame.pasts, pixelIndex(pixelPosition), picture.past);
}

void keepPicture(Picture picture, uvec2 pixelPosition)
{
    picture.pixel.albedo *= picture.weightSum;
    storePixel(rtFrame.pixels, pixelIndex(pixelPosition), picture.pixel);
    if ((rtFrame.flags & kFrameHistory) != 0u)
        keepPlace(picture, pixelPosition);
}

#endif
