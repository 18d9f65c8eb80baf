// Views and surfaces of two frames: what turns a place of one picture into that of another.
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
SHARED_CONST kMotionShape = 3u; // its corners move one by one

// Surfaces of one instance in another frame.
struct RtMotion {
    vec4 rows[3];           // world there from world here, of the entity; of a shape: directions only
    vec4 shapeRows[3];      // shape: world there from model there
    SHARED_ADDRESS corners; // shape: vec3[], model space there, by vertex
    SHARED_ADDRESS indices; // shape: uint[3] a triangle, in `corners`
    uint kind;              // kMotion*
    float inverseError;     // shape: of the back end, see lib/offset.glsl
};

// Where what a pixel shows appears to be: its lit layer, or else the first thing that hides what is behind it; its
// image where it is seen in a mirror or portal. Enough to tell whether two pixels show the same surface.
struct RtGuide {
    vec3 position;
    uint normal; // packNormal(); kNoNormal: takes no light
};

// The same in the frame before.
struct RtPast {
    vec3 position;
    uint normal; // packNormal(), kNoNormal; kNoPast: unknown
};

SHARED_END
#endif
