// The blue-noise masks: one text for C++ and GLSL.
#ifndef Q3RT_SHARED_RT_NOISE_H
#define Q3RT_SHARED_RT_NOISE_H
#include "types.h"
SHARED_BEGIN

SHARED_CONST kBlueNoiseSide = 64u; // texels; the masks tile
SHARED_CONST kBlueNoiseBits = 12u; // of a rank: side^2 of them

// Ranks of four masks at one texel, 16 bits each.
struct RtNoise {
    uint xy;
    uint zw;
};

SHARED_END
#endif
