// Places and points of one frame in another.
#ifndef Q3RT_RT_MOTION_GLSL
#define Q3RT_RT_MOTION_GLSL
#include "lib/offset.glsl"
#include "lib/projection.glsl"
#include "shared/rt_motion.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MotionTable { RtMotion at[]; };

vec3 projectTo(RtCamera camera, vec3 point)
{
    return projectPoint(camera.eye, camera.forward, camera.left, camera.up, camera.forwardUnit, point);
}

float cosineFrom(RtCamera camera, vec3 point, vec3 normal) { return abs(dot(normal, normalize(point - camera.eye))); }

HitPoint movePoint(RtMotion motion, HitPoint point)
{
    if (motion.kind != kMotionRigid)
        return point;
    return transformHitPoint(motion.rows[0], motion.rows[1], motion.rows[2], point);
}

vec3 moveDirection(RtMotion motion, vec3 v)
{
    if (motion.kind != kMotionRigid)
        return v;
    return normalize(vec3(dot(vec3(motion.rows[0]), v), dot(vec3(motion.rows[1]), v), dot(vec3(motion.rows[2]), v)));
}

#endif
