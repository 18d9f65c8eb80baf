// Push constants of the output pass.
#ifndef Q3RT_SHARED_RT_OUTPUT_H
#define Q3RT_SHARED_RT_OUTPUT_H
#include "rt_scene.h"
SHARED_BEGIN

SHARED_CONST kCurveClamp = 0u;  // the engine's own clamp, hue kept
SHARED_CONST kCurveFilmic = 1u; // shoulder; `white` maps to 1

struct RtOutput {
    SHARED_ADDRESS picture; // vec4[], rows of `width`
    SHARED_UVEC2 corner;     // of the view on the target, pixels
    uint width;
    uint curve;
    float white; // radiance
    uint reserved;
};

SHARED_END
#endif
