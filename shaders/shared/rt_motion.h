// Views and entities of two frames: what turns a place of one picture into that of another.
#ifndef Q3RT_SHARED_RT_MOTION_H
#define Q3RT_SHARED_RT_MOTION_H
#include "constants.h"
#include "rt_scene.h"
SHARED_BEGIN

// A view as cameraDirection() of lib/ray.glsl has it.
struct RtCamera {
    vec3 eye;
    vec3 forward;
    vec3 left; // scaled by the tangent of half the field of view
    vec3 up;
    vec3 forwardUnit;
};

SHARED_CONST kMotionUnknown = 0u; // what shows it starts anew
SHARED_CONST kMotionNone = 1u;
SHARED_CONST kMotionRigid = 2u;

// World points of one frame in the world of another, for one entity.
struct RtMotion {
    vec4 rows[3];
    uint kind; // kMotion*
};

SHARED_END
#endif
