// Rays that go on in another direction: mirrors, portals, reflection by water and glass, refraction by water. A turned
// ray keeps its eye, put where it appears to be behind the surface, and begins at the surface's distance from there:
// distances, texture footprints, fog and all that depends on the eye go on as if the surface were an opening.
#ifndef Q3RT_RT_TURN_GLSL
#define Q3RT_RT_TURN_GLSL
#include "lib/offset.glsl"
#include "lib/ray.glsl"
#include "rt/scene.glsl"
#include "rt/work.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer PortalTable { RtPortal at[]; };

struct CameraRay {
    vec3 origin;     // the eye, its lens's point, or their images behind mirrors and portals
    vec3 direction;  // unit
    vec3 directionX; // of the pixels to the right and below
    vec3 directionY;
    vec3 forward; // of the view
    float from;   // distance from the origin at which the ray begins
    uint solidMask;
    uint layerMask;
};

// The ray of a thin lens (Cook, Porter, Carpenter 1984, "Distributed Ray Tracing"): from a point of the lens through
// the one that all of the lens shows sharp. `at`: in the picture, pixels; `onLens`: in the unit disc.
CameraRay makeCameraRay(vec2 at, vec2 onLens)
{
    vec2 size = vec2(rtFrame.size);
    CameraRay ray;
    vec2 aside = rtFrame.lens * onLens, turn = rtFrame.lensTurn * onLens;
    vec3 forward = rtFrame.forward - rtFrame.left * turn.x - rtFrame.up * turn.y;
    ray.origin = rtFrame.eye + rtFrame.left * aside.x + rtFrame.up * aside.y;
    ray.direction = cameraDirection(forward, rtFrame.left, rtFrame.up, at / size);
    vec2 right = vec2(rtFrame.footprint, 0.0), down = vec2(0.0, rtFrame.footprint);
    ray.directionX = cameraDirection(forward, rtFrame.left, rtFrame.up, (at + right) / size);
    ray.directionY = cameraDirection(forward, rtFrame.left, rtFrame.up, (at + down) / size);
    ray.forward = rtFrame.forward;
    ray.from = 0.0;
    ray.solidMask = kMaskSolid;
    ray.layerMask = kMaskLayer;
    return ray;
}

// Behind the surface at distance t, which the ray meets under this cosine: clear of it by the bound of two distances
// of one point, once for each of the two origins.
void beginBehind(inout CameraRay ray, vec3 oldOrigin, float t, float cosine)
{
    countWork(kWorkTurn);
    ray.from = t + sameDistanceStep(2.0 * t, length(oldOrigin) + length(ray.origin), cosine);
    ray.solidMask = kMaskSolidMirror;
    ray.layerMask = kMaskLayerMirror;
}

vec3 turnDirection(RtPortal portal, vec3 v)
{
    return normalize(
        vec3(dot(vec3(portal.rows[0]), v), dot(vec3(portal.rows[1]), v), dot(vec3(portal.rows[2]), v)));
}

void turnThroughPortal(inout CameraRay ray, RtPortal portal, float t, float cosine)
{
    vec3 oldOrigin = ray.origin;
    vec4 o = vec4(oldOrigin, 1.0);
    ray.origin = vec3(dot(portal.rows[0], o), dot(portal.rows[1], o), dot(portal.rows[2], o));
    ray.direction = turnDirection(portal, ray.direction);
    ray.directionX = turnDirection(portal, ray.directionX);
    ray.directionY = turnDirection(portal, ray.directionY);
    ray.forward = turnDirection(portal, ray.forward);
    beginBehind(ray, oldOrigin, t, cosine);
}

// Reflection at a plane through `position`.
void turnAtPlane(inout CameraRay ray, vec3 position, vec3 normal, float t)
{
    float cosine = abs(dot(ray.direction, normal));
    vec3 oldOrigin = ray.origin;
    ray.origin -= normal * (2.0 * dot(normal, ray.origin - position));
    ray.direction = reflect(ray.direction, normal);
    ray.directionX = reflect(ray.directionX, normal);
    ray.directionY = reflect(ray.directionY, normal);
    ray.forward = reflect(ray.forward, normal);
    beginBehind(ray, oldOrigin, t, cosine);
}

// The rotation that takes one unit direction to another along the great circle between them (Rodrigues).
vec3 rotateAlong(vec3 v, vec3 from, vec3 to)
{
    vec3 axis = cross(from, to);
    float cosine = dot(from, to);
    return v * cosine + cross(axis, v) + axis * (dot(axis, v) / (1.0 + cosine));
}

// Refraction at a plane through `position`, `normal` on the ray's side; `ratio` of the indices before and behind
// (Snell). The eye turns about the point with its ray: distances are those along the bent line. True: it has turned, no
// total reflection stood in the way.
bool bendAtPlane(inout CameraRay ray, vec3 position, vec3 normal, float ratio, float t)
{
    vec3 bent = refract(ray.direction, normal, ratio);
    if (bent == vec3(0.0))
        return false;
    bent = normalize(bent);
    float cosine = min(-dot(ray.direction, normal), -dot(bent, normal));
    vec3 oldOrigin = ray.origin;
    uint solidMask = ray.solidMask, layerMask = ray.layerMask;
    ray.origin = position - bent * distance(position, oldOrigin);
    ray.directionX = normalize(rotateAlong(ray.directionX, ray.direction, bent));
    ray.directionY = normalize(rotateAlong(ray.directionY, ray.direction, bent));
    ray.forward = rotateAlong(ray.forward, ray.direction, bent);
    ray.direction = bent;
    beginBehind(ray, oldOrigin, t, cosine);
    ray.solidMask = solidMask;
    ray.layerMask = layerMask;
    return true;
}

// Share of light that the surface between air and a medium of refractive index n reflects (Schlick 1994, "An
// Inexpensive BRDF Model for Physically-based Rendering"); from inside by the angle outside, total beyond the critical
// one.
float reflectedShare(float cosine, float index, bool inside)
{
    if (inside) {
        float sine2 = index * index * (1.0 - cosine * cosine);
        if (sine2 >= 1.0)
            return 1.0;
        cosine = sqrt(1.0 - sine2);
    }
    float base = (index - 1.0) / (index + 1.0);
    float away = 1.0 - cosine;
    float away2 = away * away;
    return base * base + (1.0 - base * base) * away2 * away2 * away;
}

#endif
