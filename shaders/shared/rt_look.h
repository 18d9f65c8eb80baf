// What the first look of a pixel's camera ray met, on its way from the stage that traces it to those that shade.
#ifndef Q3RT_SHARED_RT_LOOK_H
#define Q3RT_SHARED_RT_LOOK_H
#include "rt_scene.h"
SHARED_BEGIN

SHARED_CONST kLookNear = 0x1u; // seen in the near depth range
SHARED_CONST kLookOn = 0x2u;   // the pixel needs more rays: the primary stage draws it
SHARED_CONST kLookLayered = 0x4u; // layers are in front of what was seen

// One a pixel, row by row.
struct RtLook {
    float t; // of the first solid; 0: there is none
    uint instance;
    uint triangle;
    uint state; // kLook*
    vec2 barycentric; // weights of corners 1 and 2
    SHARED_UVEC2 reserved;
};

SHARED_END
#endif
