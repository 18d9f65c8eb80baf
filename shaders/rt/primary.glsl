// Picture of one pixel: the first solid along the camera ray, then the layers in front of it, composed exactly from
// front to back:  picture = sum over layers of P_before x (A L + B),  P_before = product of the P in front.
// L is only known after the direct stage, for one point a pixel. If several layers take light, one of them is kept at
// random in proportion to what L would be multiplied by, its A divided by that probability: the mean is exact.
#ifndef Q3RT_RT_PRIMARY_GLSL
#define Q3RT_RT_PRIMARY_GLSL
#include "lib/random.glsl"
#include "rt/accept.glsl"
#include "rt/camera.glsl"
#include "rt/picture.glsl"
#include "rt/sky.glsl"
#include "rt/work.glsl"

// Numbers of a ray's parts: near depth range 0, far one 1, one more for each turn; of a reflection from here on.
const uint kReflectionPart = 32u;

// On the eye's side; a shading normal may point away from the eye, or send the reflection into the surface.
vec3 facingNormal(SurfacePoint point, vec3 direction)
{
    vec3 normal = point.frontFace ? point.normal : -point.normal;
    bool fits = dot(normal, direction) < 0.0 && dot(reflect(direction, normal), point.geometricNormal) > 0.0;
    return fits ? normal : point.geometricNormal;
}

// What water or glass reflects. True: the ray goes on as the reflected one.
bool addReflection(inout Picture picture, inout CameraRay ray, SurfacePoint point, float t, float random)
{
    bool water = (point.surface.flags & kSurfaceWater) != 0u;
    vec3 normal = facingNormal(point, ray.direction);
    float share = reflectedShare(min(-dot(normal, ray.direction), 1.0), water ? kWaterIndex : kGlassIndex,
                                 water && !point.frontFace);
    if (picture.turns == 0u && !picture.reflected) {
        picture.reflected = true;
        picture.reflection = Reflection(picture.passed * share, point.hit.position, normal, t, picture.onLens);
        picture.passed *= 1.0 - share;
        return false;
    }
    if (random >= share)
        return false;
    turnAtPlane(ray, point.hit.position, normal, t);
    return true;
}

// True: the ray has turned, and what is straight on does not show.
bool addHit(inout Picture picture, inout CameraRay ray, Hit hit, vec2 random)
{
    SurfacePoint point = makeSurfacePoint(hit.instance, hit.triangle, hit.barycentric, ray.origin, ray.direction,
                                          ray.directionX, ray.directionY);
    if ((point.surface.flags & (kSurfaceWater | kSurfaceGlass)) != 0u &&
        addReflection(picture, ray, point, hit.t, random.y))
        return true;
    addLayer(picture, ray, point, SurfacePlace(hit.instance, hit.triangle, hit.barycentric, hit.t),
             shadeSurface(point, ray.origin, ray.forward), random.x);
    if ((point.surface.flags & kSurfaceWater) != 0u && (rtFrame.flags & kFrameRefraction) != 0u &&
        picture.turns < rtFrame.reflectionDepth && picture.passed != vec3(0.0))
        return bendAtPlane(ray, point.hit.position, facingNormal(point, ray.direction),
                           point.frontFace ? 1.0 / kWaterIndex : kWaterIndex, hit.t);
    if (point.surface.portal == 0u || !point.frontFace || picture.passed == vec3(0.0))
        return false;
    turnThroughPortal(ray, PortalTable(rtFrame.portals).at[point.surface.portal - 1u], hit.t,
                      abs(dot(point.geometricNormal, ray.direction)));
    return true;
}

// What a ray looks for next.
const uint kLookNowhere = 0u; // there is something left of the last look
const uint kLookAhead = 1u;   // the first solid of a depth range, and the layers in front of it
const uint kLookLayers = 2u;  // more layers in front of it: a batch was full
const uint kLookBehind = 3u;  // the next solid, behind one that lets something through
const uint kLookSky = 4u;     // which sky

// A ray in one depth range: what was seen and has not been used yet.
struct Outlook {
    uint look;
    Sight sight;
    bool full;        // there may be more layers behind those of `sight`
    float from;       // where solids are looked for
    float limit;      // the first solid's distance: layers behind it are hidden
    uint layerNumber; // layers used, for random numbers
};

Outlook lookAhead(CameraRay ray)
{
    return Outlook(kLookAhead, Sight(noHit(), emptyBatch(LayerKey(ray.from, 0u, 0u))), false, ray.from, 0.0, 0u);
}

// What the look stage found is not looked for again.
Outlook afterFirstLook(RtLook seen, CameraRay ray)
{
    Sight sight = Sight(Hit(seen.t, seen.instance, seen.triangle, seen.barycentric),
                        emptyBatch(LayerKey(ray.from, 0u, 0u)));
    return Outlook((seen.state & kLookLayered) != 0u ? kLookLayers : kLookNowhere, sight, false, ray.from,
                   seen.t > 0.0 ? seen.t : ray.from + rtFrame.farQu, 0u);
}

// The one place where camera rays are traced: what is inlined here is large.
void look(inout Outlook view, CameraRay ray)
{
    bool more = view.look == kLookLayers;
    uint solidMask = more ? 0u : view.look == kLookSky ? kMaskSky : ray.solidMask;
    bool layered = (more || view.look == kLookAhead) && showsLayers();
    float from = more ? view.sight.layers.after.distance : view.from;
    float farthest = more ? view.limit : ray.from + rtFrame.farQu;
    Hit solid = view.sight.solid;
    countRay();
    view.sight = traceSight(ray.origin, ray.direction, from, farthest, solidMask, layered ? ray.layerMask : 0u,
                            view.sight.layers.after);
    if (more)
        view.sight.solid = solid;
    if (view.look == kLookAhead)
        view.limit = view.sight.solid.t > 0.0 ? view.sight.solid.t : farthest;
    view.full = view.sight.layers.count == kLayersPerBatch;
    view.look = kLookNowhere;
}

// The next surface along the ray: layers in front of the solid, then the solid, by turns until nothing behind shows. A
// solid that lets something through (the accept function samples the finest texels, shading the filtered ones) is
// passed at the next number after its distance; layers behind it are rare and shown in front of what is behind it.
// hit.t == 0: there is none, or view.look says what has to be looked for first. `random`: two numbers for its use.
Hit nextSurface(inout Outlook view, uvec4 key, out vec2 random)
{
    bool layered = view.sight.layers.count > 0u && view.sight.layers.layers[0].key.distance <= view.limit;
    vec4 numbers = randomNumbers(key, kDimensionLayer + (layered ? view.layerNumber << 8u : 0u));
    random = layered ? numbers.xz : numbers.yw;
    if (layered) {
        Layer layer = takeLayer(view.sight.layers);
        ++view.layerNumber;
        return Hit(layer.t, layer.key.instance, layer.key.triangle, layer.barycentric);
    }
    // Each batch ends after a larger key, and there are finitely many layers: the looking ends.
    if (view.full && view.sight.layers.count == 0u) {
        view.look = kLookLayers;
        return noHit();
    }
    if (view.sight.solid.t > 0.0) {
        view.from = view.sight.solid.t * (1.0 + 2.0 * kUnitRoundoff);
        view.look = kLookBehind;
    }
    return view.sight.solid;
}

// Follows a ray, from `view` on, through the near depth range, the far one and all turns. `part` numbers the ray's
// parts for random numbers.
void addRay(inout Picture picture, CameraRay ray, Outlook view, bool near, uint part, uvec4 key)
{
    uint sky = 0u;
    for (;;) {
        if (view.look != kLookNowhere) {
            uint looked = view.look;
            look(view, ray);
            if (looked == kLookSky) {
                Hit hit = view.sight.solid;
                if (hit.t > 0.0)
                    sky = SurfaceTable(rtFrame.surfaces).at[findTriangle(hit.instance, hit.triangle).surface].sky;
                break;
            }
        }
        vec2 random;
        Hit hit = nextSurface(view, key ^ uvec4(0u, 0u, 0u, 0x9e3779b9u * part), random);
        if (hit.t > 0.0) {
            bool turned = addHit(picture, ray, hit, random);
            if (picture.passed == vec3(0.0))
                return;
            if (!turned)
                continue;
            if (picture.turns == rtFrame.reflectionDepth)
                return;
            ++picture.turns;
        } else if (view.look == kLookLayers) {
            continue;
        } else if (near) {
            picture.onLens = picture.lens;
            ray = makeCameraRay(picture.at, picture.onLens);
        } else if ((rtFrame.flags & kFrameSkySurfaces) != 0u) {
            view.look = kLookSky;
            view.from = ray.from;
            continue;
        } else {
            break;
        }
        near = false;
        ++part;
        view = lookAhead(ray);
    }
    if (rtFrame.skyCount > 0u)
        picture.pixel.emission += picture.passed * skyColor(SkyTable(rtFrame.skies).at[sky], ray.direction,
                                                            ray.directionX, ray.directionY);
}

// Draws the pixels that the stage before left.
void primaryPixel(uvec2 pixelPosition)
{
    RtLook seen = loadLook(rtFrame.looks, pixelIndex(pixelPosition));
    if ((seen.state & kLookOn) == 0u)
        return;
    CameraPlace place = cameraPlace(pixelPosition);
    place.near = (seen.state & kLookNear) != 0u;
    uvec4 key = randomKey(pixelPosition);
    Picture picture = beginPicture(place, pixelPosition);
    bool near = place.near;
    uint part = near ? 0u : 1u;
    CameraRay ray = near ? nearRay(picture.at) : makeCameraRay(picture.at, picture.onLens);
    Outlook view = afterFirstLook(seen, ray);
    // Once for the camera ray, once more for a reflection of it.
    for (;;) {
        addRay(picture, ray, view, near, part, key);
        if (picture.reflection.passed == vec3(0.0))
            break;
        picture.passed = picture.reflection.passed;
        picture.reflection.passed = vec3(0.0);
        picture.turns = 1u;
        picture.onLens = picture.reflection.onLens;
        ray = makeCameraRay(picture.at, picture.onLens);
        turnAtPlane(ray, picture.reflection.position, picture.reflection.normal, picture.reflection.t);
        view = lookAhead(ray);
        near = false;
        part = kReflectionPart;
    }
    keepPicture(picture, pixelPosition);
    reportRays(pixelPosition);
}

#endif
