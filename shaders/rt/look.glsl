// First look of one pixel: what its camera ray meets first, and whether there are layers in front of that. Nothing is
// shaded: a search that carries little along is traced by many more rays at a time.
#ifndef Q3RT_RT_LOOK_GLSL
#define Q3RT_RT_LOOK_GLSL
#include "rt/camera.glsl"
#include "rt/rows.glsl"
#include "rt/work.glsl"

void lookPixel(uvec2 pixelPosition)
{
    CameraPlace place = cameraPlace(pixelPosition);
    bool near = place.near;
    CameraRay ray = makeCameraRay(place.at, place.lens);
    if (near)
        ray = nearRay(place.at);
    for (;;) {
        countRay();
        Sight sight = traceSight(ray.origin, ray.direction, 0.0, rtFrame.farQu, ray.solidMask,
                                 showsLayers() ? ray.layerMask : 0u, LayerKey(0.0, 0u, 0u));
        float limit = sight.solid.t > 0.0 ? sight.solid.t : rtFrame.farQu;
        bool layered = sight.layers.count > 0u && sight.layers.layers[0].key.distance <= limit;
        if (near && !layered && sight.solid.t == 0.0) {
            near = false;
            ray = makeCameraRay(place.at, place.lens);
            continue;
        }
        Hit hit = sight.solid;
        uint state = (near ? kLookNear : 0u) | (layered ? kLookOn | kLookLayered : 0u);
        storeLook(rtFrame.looks, pixelIndex(pixelPosition),
                  RtLook(hit.t, hit.instance, hit.triangle, state, hit.barycentric, uvec2(0u)));
        break;
    }
    reportRays(pixelPosition);
}

#endif
