// Where what a camera ray meets appeared to be in the frame before.
#ifndef Q3RT_RT_PAST_GLSL
#define Q3RT_RT_PAST_GLSL
#include "lib/denoise.glsl"
#include "rt/motion.glsl"
#include "rt/surface.glsl"
#include "rt/turn.glsl"

// A point of the scene by number, and its unfolded distance.
struct SurfacePlace {
    uint instance;
    uint triangle;
    vec2 barycentric;
    float t;
};

// A vector at the end of a turned ray as the eye sees it there: the turns undone. The ray and its neighbours span space
// before and after the turns; one pixel apart they leave 4 digits, enough for a motion of some units.
vec3 undoTurns(vec3 v, CameraRay straight, CameraRay turned)
{
    vec3 a = turned.direction, b = turned.directionX - a, c = turned.directionY - a;
    vec3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
    float volume = dot(a, bc);
    if (volume == 0.0)
        return v;
    vec3 share = vec3(dot(v, bc), dot(v, ca), dot(v, ab)) / volume;
    return share.x * straight.direction + share.y * (straight.directionX - straight.direction) +
           share.z * (straight.directionY - straight.direction);
}

RtPast findPast(RtGuide guide, SurfacePlace place, SurfacePoint point, CameraRay straight, CameraRay ray)
{
    RtPast past = RtPast(guide.position, guide.normal);
    RtMotion motion = MotionTable(rtFrame.motionToPrevious).at[place.instance];
    if (motion.kind == kMotionNone)
        return past;
    if (motion.kind == kMotionUnknown) {
        past.normal = kNoPast;
        return past;
    }
    vec3 shift = movePoint(motion, place.triangle, place.barycentric, point.hit).position - point.hit.position;
    bool isTurned = ray.direction != straight.direction;
    past.position += isTurned ? undoTurns(shift, straight, ray) : shift;
    if (guide.normal != kNoNormal)
        past.normal = packNormal(moveDirection(motion, unpackNormal(guide.normal)));
    return past;
}

#endif
