// Automatic exposure: one text for C++ and GLSL, scalar layout.
#ifndef Q3RT_SHARED_RT_EXPOSURE_H
#define Q3RT_SHARED_RT_EXPOSURE_H
#include "constants.h"
#include "rt_scene.h"
SHARED_BEGIN

// Bins of the histogram: log2 of luminance, evenly from the darkest to the brightest; darker pixels are not counted.
SHARED_CONST kExposureBinCount = 64u;
SHARED_FLOAT kDarkestLog2 = -12.0f;
SHARED_FLOAT kBrightestLog2 = 6.0f;
// Luminance that the middle of the picture is brought to: middle grey.
SHARED_FLOAT kExposureKey = 0.18f;
// Shares of the counted pixels that are left out as too dark and too bright.
SHARED_FLOAT kExposureLowShare = 0.4f;
SHARED_FLOAT kExposureHighShare = 0.05f;
// It changes the exposure by at most these stops.
SHARED_FLOAT kExposureRangeStops = 4.0f;

// Kept by a view from frame to frame.
struct RtExposure {
    float stops;         // log2 of the factor beyond rt_exposure, of the next frame's picture
    float previousStops; // of the picture before
    uint bins[kExposureBinCount];
};

struct RtExposurePush {
    SHARED_ADDRESS frame;
    SHARED_ADDRESS exposure; // RtExposure
    float mostStops;         // that it may change by now
    uint reserved;
};

SHARED_END
#endif
