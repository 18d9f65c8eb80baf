// Places and points of one frame in another.
#ifndef Q3RT_RT_MOTION_GLSL
#define Q3RT_RT_MOTION_GLSL
#include "lib/offset.glsl"
#include "lib/projection.glsl"
#include "rt/rows.glsl"
#include "shared/rt_motion.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer MotionTable { RtMotion at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CornerTable { vec3 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CornerIndexTable { uint at[]; };

vec3 projectTo(RtCamera camera, vec3 point)
{
    return projectPoint(camera.eye, camera.forward, camera.left, camera.up, camera.forwardUnit, point);
}

float cosineFrom(RtCamera camera, vec3 point, vec3 normal) { return abs(dot(normal, normalize(point - camera.eye))); }

// A point of an instance's surface, `barycentric` of a triangle of it, in the other frame.
HitPoint movePoint(RtMotion motion, uint triangle, vec2 barycentric, HitPoint point)
{
    // A point's error knows its instance's way back already.
    if (motion.kind == kMotionRigid)
        return transformHitPoint(motion.rows[0], motion.rows[1], motion.rows[2], point, 0.0);
    if (motion.kind != kMotionShape)
        return point;
    CornerIndexTable indices = CornerIndexTable(motion.indices);
    CornerTable corners = CornerTable(motion.corners);
    HitPoint local = makeHitPoint(corners.at[indices.at[3u * triangle]], corners.at[indices.at[3u * triangle + 1u]],
                                  corners.at[indices.at[3u * triangle + 2u]], barycentric);
    return transformHitPoint(motion.shapeRows[0], motion.shapeRows[1], motion.shapeRows[2], local,
                             motion.inverseError);
}

// Of a shape this is its entity's turn alone.
vec3 moveDirection(RtMotion motion, vec3 v)
{
    if (motion.kind == kMotionNone)
        return v;
    return normalize(vec3(dot(vec3(motion.rows[0]), v), dot(vec3(motion.rows[1]), v), dot(vec3(motion.rows[2]), v)));
}

#endif
