// Where a pixel's camera ray begins and through which point of the picture it goes.
#ifndef Q3RT_RT_CAMERA_GLSL
#define Q3RT_RT_CAMERA_GLSL
#include "rt/lights.glsl"
#include "rt/sampler.glsl"
#include "rt/turn.glsl"

struct CameraPlace {
    vec2 at;   // in the picture, pixels
    vec2 lens; // on the lens, unit disc
    bool near; // something of the near depth range may show here; that has no lens
};

CameraPlace cameraPlace(uvec2 pixelPosition)
{
    vec4 numbers = (rtFrame.flags & (kFrameAntialiasing | kFrameLens)) != 0u
                       ? sampleNumbers(randomKey(pixelPosition), kDimensionLens)
                       : vec4(0.5);
    vec2 inPixel = vec2(0.5);
    if ((rtFrame.flags & kFrameAntialiasing) != 0u)
        inPixel = (rtFrame.flags & kFrameSharedJitter) != 0u ? rtFrame.jitter : numbers.xy;
    CameraPlace place;
    place.at = vec2(pixelPosition) + inPixel;
    place.lens = sampleDisc(numbers.z, numbers.w);
    place.near = (rtFrame.flags & kFrameNearEntities) != 0u &&
                 all(greaterThanEqual(place.at, rtFrame.nearArea.xy)) &&
                 all(lessThanEqual(place.at, rtFrame.nearArea.zw));
    return place;
}

CameraRay nearRay(vec2 at)
{
    CameraRay ray = makeCameraRay(at, vec2(0.0));
    ray.solidMask = kMaskNearSolid;
    ray.layerMask = kMaskNearLayer;
    return ray;
}

bool showsLayers() { return (rtFrame.flags & kFrameLayers) != 0u; }

#endif
