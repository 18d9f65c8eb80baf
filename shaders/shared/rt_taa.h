// What temporal anti-aliasing reads: one text for C++ and GLSL, scalar layout.
#ifndef Q3RT_SHARED_RT_TAA_H
#define Q3RT_SHARED_RT_TAA_H
#include "rt_motion.h"
SHARED_BEGIN

// Frames that a pixel's mean spans at most: of what stands still in the picture, and of what moves in it. What moves is
// resampled in each frame and loses sharpness, and its old colours are less sure.
SHARED_FLOAT kTaaStillLimit = 24.0f;
SHARED_FLOAT kTaaMovingLimit = 4.0f;

// Share of a sample that a colour counts for which is only interpolated between samples: where the picture has more
// pixels than there are samples.
SHARED_FLOAT kGuessWeight = 0.25f;

struct RtTaa {
    SHARED_ADDRESS guides;  // RtGuide[]
    SHARED_ADDRESS pasts;   // RtPast[]
    SHARED_ADDRESS picture; // vec4[]: this frame's, exposed
    SHARED_ADDRESS history; // vec4[], outputSize: the result; w: samples in it
    SHARED_ADDRESS previousHistory;
    SHARED_ADDRESS gradients;    // vec4[], a stratum: the denoiser's filtered change of light; 0: there is none
    SHARED_ADDRESS autoExposure; // RtExposure; 0: there is none
    RtCamera camera;
    RtCamera previousCamera;
    SHARED_UVEC2 size; // traced pixels
    SHARED_UVEC2 strata;
    SHARED_UVEC2 outputSize; // at least `size`
    vec2 jitter;             // where in its pixel each sample lies, [0, 1)
    uint hasHistory;         // previousHistory holds the frame before
    uint reserved;
};

struct RtTaaPush {
    SHARED_ADDRESS taa;
};

SHARED_END
#endif
