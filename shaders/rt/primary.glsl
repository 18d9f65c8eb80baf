// Primary stage of one pixel: the first solid along the camera ray, then the layers in front of it, composed exactly
// from front to back:  picture = sum over layers of P_before x (A L + B),  P_before = product of the P in front.
// L is only known after the direct stage, for one point a pixel. If several layers take light, one of them is kept at
// random in proportion to what L would be multiplied by, its A divided by that probability: the mean is exact.
#ifndef Q3RT_RT_PRIMARY_GLSL
#define Q3RT_RT_PRIMARY_GLSL
#include "lib/random.glsl"
#include "rt/accept.glsl"
#include "rt/lights.glsl"
#include "rt/sky.glsl"

struct CameraRay {
    vec3 origin;
    vec3 direction; // unit
    vec3 directionX; // of the pixels to the right and below
    vec3 directionY;
};

struct Picture {
    vec3 passed; // what the layers so far let through
    RtPixel pixel;
    float weightSum; // of the layers that take light
};

CameraRay makeCameraRay(uvec2 pixel, vec2 inPixel)
{
    vec2 size = vec2(rtFrame.size);
    vec2 at = vec2(pixel) + inPixel;
    CameraRay ray;
    ray.origin = rtFrame.eye;
    ray.direction = cameraDirection(rtFrame.forward, rtFrame.left, rtFrame.up, at / size);
    ray.directionX = cameraDirection(rtFrame.forward, rtFrame.left, rtFrame.up, (at + vec2(1.0, 0.0)) / size);
    ray.directionY = cameraDirection(rtFrame.forward, rtFrame.left, rtFrame.up, (at + vec2(0.0, 1.0)) / size);
    return ray;
}

void addLayer(inout Picture picture, SurfacePoint point, MaterialColor color, float random)
{
    picture.pixel.emission += picture.passed * color.glow;
    vec3 albedo = picture.passed * color.albedo;
    float weight = albedo.x + albedo.y + albedo.z;
    if (weight > 0.0) {
        picture.weightSum += weight;
        if (random * picture.weightSum < weight) {
            picture.pixel.lit = 1u;
            picture.pixel.position = point.hit.position;
            picture.pixel.error = point.hit.error;
            picture.pixel.geometricNormal = point.geometricNormal;
            // A surface seen from behind is lit on the side that is seen.
            picture.pixel.normal = point.frontFace ? point.normal : -point.normal;
            picture.pixel.albedo = albedo / weight;
            picture.pixel.entity = point.entity;
        }
    }
    picture.passed *= color.through;
}

void addHit(inout Picture picture, CameraRay ray, uint instance, uint triangle, vec2 barycentric, float random)
{
    SurfacePoint point =
        makeSurfacePoint(instance, triangle, barycentric, ray.origin, ray.direction, ray.directionX, ray.directionY);
    addLayer(picture, point, shadeSurface(point), random);
}

// All layers in (0, tMax] in front of `limit` in drawing order, in batches. Each batch ends after a larger key, and
// there are finitely many layers: the loop ends. It also ends where nothing behind can show any more.
void addLayers(inout Picture picture, CameraRay ray, uint mask, float tMax, float limit, uvec4 key)
{
    LayerKey after = LayerKey(0.0, 0u, 0u);
    uint number = 0u;
    for (;;) {
        LayerBatch batch = traceLayers(ray.origin, ray.direction, tMax, mask, after);
        for (uint i = 0u; i < batch.count; ++i) {
            Layer layer = batch.layers[i];
            if (layer.key.distance > limit || picture.passed == vec3(0.0))
                return;
            float random = randomNumbers(key, kDimensionLayer + (number << 8u)).x;
            addHit(picture, ray, layer.key.instance, layer.key.triangle, layer.barycentric, random);
            ++number;
        }
        if (batch.count < kLayersPerBatch)
            return;
        after = batch.layers[kLayersPerBatch - 1u].key;
    }
}

// One depth range: layers and solids by turns until nothing behind shows. A solid that lets something through (the
// accept function samples the finest texels, shading the filtered ones) is passed at the next number after its
// distance. Returns the first solid's distance, 0 if there is none.
float addRange(inout Picture picture, CameraRay ray, uint solidMask, uint layerMask, uvec4 key)
{
    float first = 0.0;
    float from = 0.0;
    bool layered = false;
    for (;;) {
        Hit solid = traceClosest(ray.origin, ray.direction, from, rtFrame.farQu, solidMask, true);
        if ((rtFrame.flags & kFrameLayers) != 0u && !layered) {
            // Layers behind a solid that lets light through are rare and shown in front of what is behind it.
            float limit = solid.t > 0.0 ? solid.t : rtFrame.farQu;
            float step = sameDistanceStep(limit, length(rtFrame.eye), kGrazingCosine);
            addLayers(picture, ray, layerMask, limit + step * float(rtFrame.layerOrderCount + 1u), limit, key);
            layered = true;
        }
        if (first == 0.0)
            first = solid.t;
        if (solid.t == 0.0 || picture.passed == vec3(0.0))
            return first;
        addHit(picture, ray, solid.instance, solid.triangle, solid.barycentric, randomNumbers(key, kDimensionLayer).y);
        if (picture.passed == vec3(0.0))
            return first;
        from = solid.t * (1.0 + 2.0 * kUnitRoundoff);
    }
    return first;
}

void addSky(inout Picture picture, CameraRay ray)
{
    if (rtFrame.skyCount == 0u)
        return;
    uint sky = 0u;
    if ((rtFrame.flags & kFrameSkySurfaces) != 0u) {
        Hit hit = traceClosest(ray.origin, ray.direction, 0.0, rtFrame.farQu, kMaskSky, true);
        if (hit.t > 0.0)
            sky = SurfaceTable(rtFrame.surfaces).at[findTriangle(hit.instance, hit.triangle).surface].sky;
    }
    picture.pixel.emission += picture.passed * skyColor(SkyTable(rtFrame.skies).at[sky], ray.direction, ray.directionX,
                                                        ray.directionY);
}

void primaryPixel(uvec2 pixelPosition)
{
    uvec4 key = randomKey(pixelPosition);
    vec2 inPixel = vec2(0.5);
    if ((rtFrame.flags & kFrameAntialiasing) != 0u)
        inPixel = (rtFrame.flags & kFrameSharedJitter) != 0u ? rtFrame.jitter : randomNumbers(key, kDimensionLens).xy;
    CameraRay ray = makeCameraRay(pixelPosition, inPixel);
    Picture picture;
    picture.passed = vec3(1.0);
    picture.weightSum = 0.0;
    picture.pixel = RtPixel(vec3(0.0), 0u, vec3(0.0), 0.0, vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0),
                            vec3(0.0), packKeyPixel(pixelPosition), rtFrame.frame, 0u);
    float distance = 0.0;
    if ((rtFrame.flags & kFrameNearEntities) != 0u)
        distance = addRange(picture, ray, kMaskNearSolid, kMaskNearLayer, key);
    if (picture.passed != vec3(0.0))
        distance = addRange(picture, ray, kMaskSolid, kMaskLayer, key ^ uvec4(0u, 0u, 0u, 0x9e3779b9u));
    if (picture.passed != vec3(0.0))
        addSky(picture, ray);
    picture.pixel.albedo *= picture.weightSum;
    picture.pixel.distance = distance;
    PixelTable(rtFrame.pixels).at[pixelIndex(pixelPosition)] = picture.pixel;
}

#endif
