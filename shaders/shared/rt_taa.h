// What temporal anti-aliasing reads: one text for C++ and GLSL, scalar layout.
#ifndef Q3RT_SHARED_RT_TAA_H
#define Q3RT_SHARED_RT_TAA_H
#include "rt_motion.h"
SHARED_BEGIN

// Frames that a pixel's mean spans at most: of what stands still in the picture, and of what moves in it. What moves is
// resampled in each frame and loses sharpness, and its old colours are less sure.
SHARED_FLOAT kTaaStillLimit = 24.0f;
SHARED_FLOAT kTaaMovingLimit = 4.0f;

struct RtTaa {
    SHARED_ADDRESS guides;  // RtGuide[]
    SHARED_ADDRESS pasts;   // RtPast[]
    SHARED_ADDRESS picture; // vec4[]: this frame's, exposed
    SHARED_ADDRESS history; // vec4[]: the result; w: frames in it
    SHARED_ADDRESS previousHistory;
    SHARED_ADDRESS gradients; // vec2[], a stratum: the denoiser's filtered change of light; 0: there is none
    RtCamera camera;
    RtCamera previousCamera;
    SHARED_UVEC2 size; // pixels
    SHARED_UVEC2 strata;
    uint hasHistory;   // previousHistory holds the frame before
    uint reserved;
};

struct RtTaaPush {
    SHARED_ADDRESS taa;
};

SHARED_END
#endif
