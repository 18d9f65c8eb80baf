// Arithmetic of automatic exposure. Pure functions.
#ifndef Q3RT_LIB_EXPOSURE_GLSL
#define Q3RT_LIB_EXPOSURE_GLSL
#include "shared/constants.h"
#include "shared/rt_exposure.h"

// Mean log2 luminance of the pixels between the shares left out below and above, brought to the key. `now`: what to
// keep if the picture is black.
float wantedStops(uint bins[kExposureBinCount], float now)
{
    float total = 0.0f;
    for (uint i = 0u; i < kExposureBinCount; ++i)
        total += float(bins[i]);
    if (total == 0.0f)
        return now;
    float first = kExposureLowShare * total, last = (1.0f - kExposureHighShare) * total;
    float below = 0.0f, sum = 0.0f, weight = 0.0f;
    for (uint i = 0u; i < kExposureBinCount; ++i) {
        float above = below + float(bins[i]);
        float counted = max(min(above, last) - max(below, first), 0.0f);
        float place = (float(i) + 0.5f) / float(kExposureBinCount);
        sum += counted * (kDarkestLog2 + place * (kBrightestLog2 - kDarkestLog2));
        weight += counted;
        below = above;
    }
    float stops = log2(kExposureKey) - sum / weight;
    return clamp(stops, -kExposureRangeStops, kExposureRangeStops);
}

float adaptStops(float now, float wanted, float most) { return now + clamp(wanted - now, -most, most); }

#endif
