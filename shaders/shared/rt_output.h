// The output curve, and what the output pass reads.
#ifndef Q3RT_SHARED_RT_OUTPUT_H
#define Q3RT_SHARED_RT_OUTPUT_H
#include "rt_scene.h"
SHARED_BEGIN

SHARED_CONST kCurveClamp = 0u; // the engine's own clamp, hue kept
SHARED_CONST kCurveFilmic = 1u;
SHARED_CONST kCurveReinhard = 2u;

struct RtOutput {
    SHARED_ADDRESS frame;   // RtFrame
    SHARED_ADDRESS picture; // vec4[], of the view
    SHARED_ADDRESS right;   // the same: shown from column `split` on
    SHARED_UVEC2 corner;    // of the view on the target, pixels
    SHARED_UVEC2 size;      // of the view
    uint split;
    uint firstColumn; // that is shown
};

SHARED_END
#endif
