// What the denoiser's passes read: one text for C++ and GLSL, scalar layout. See
// docs/denoising.md for the order of the passes.
#ifndef Q3RT_SHARED_RT_DENOISE_H
#define Q3RT_SHARED_RT_DENOISE_H
#include "rt_motion.h"
SHARED_BEGIN

SHARED_CONST kStratumPixels = 3u; // a side
SHARED_CONST kNoWinner = 0xffffffffu;

// Levels of the filters; level i reaches 2^i texels of its grid a tap. Both counts decide in which of two buffers the
// result lies: level i goes from buffer i & 1 to the other one.
SHARED_CONST kGradientLevels = 4u;
SHARED_CONST kFilterLevels = 5u;

// Share of a new frame in the mean at least, where nothing says what has changed (SVGF, section 4.1: 0.2; Schied,
// Peters, Dachsbacher 2018, section 6, compare with 0.1).
SHARED_FLOAT kFixedShare = 0.1f;
// Frames that the mean of an unchanged pixel spans at most.
SHARED_FLOAT kHistoryLimit = 64.0f;
// From this many samples on a pixel's own moments give its variance, before that its neighbours'.
SHARED_FLOAT kTemporalVarianceSamples = 4.0f;

SHARED_CONST kDenoiseHistory = 0x1u;  // the previous frame's buffers hold something
SHARED_CONST kDenoiseGradient = 0x2u; // there are gradients

struct RtDenoise {
    SHARED_ADDRESS pixels; // RtPixel[]
    SHARED_ADDRESS previousPixels;
    SHARED_ADDRESS irradiance; // vec4[]: L as traced
    SHARED_ADDRESS previousIrradiance;
    SHARED_ADDRESS guides; // RtGuide[]
    SHARED_ADDRESS previousGuides;
    SHARED_ADDRESS pasts; // RtPast[]
    SHARED_ADDRESS light; // vec4[]: mean L over frames; w: samples in it
    SHARED_ADDRESS previousLight;
    SHARED_ADDRESS moments; // vec2[]: means of luminance and its square
    SHARED_ADDRESS previousMoments;
    SHARED_ADDRESS winners;      // uint[], a stratum: packWinner() of the sample carried into it, or kNoWinner
    SHARED_ADDRESS gradients[2]; // vec4[], a stratum: see historyLoss(); w: unused
    SHARED_ADDRESS filtered[2];  // vec4[]: L; w: variance of its luminance
    SHARED_ADDRESS motionToCurrent; // RtMotion[], by instance of the previous frame
    RtCamera camera;
    RtCamera previousCamera;
    SHARED_UVEC2 size;   // pixels
    SHARED_UVEC2 strata; // size / 3, rounded up
    uint frame;          // of random numbers
    uint previousFrame;
    float pixelTangent; // width of a pixel at depth 1 (the larger of both ways)
    uint flags;         // kDenoise*
};

struct RtDenoisePush {
    SHARED_ADDRESS denoise;
    uint level;
    uint reserved;
};

SHARED_END
#endif
