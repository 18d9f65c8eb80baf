// What a frame's shaders count for the CPU: one text for C++ and GLSL, scalar layout.
#ifndef Q3RT_SHARED_RT_REPORT_H
#define Q3RT_SHARED_RT_REPORT_H
#include "constants.h"
#include "rt_scene.h"
SHARED_BEGIN

// Sums of numbers in [0, 1], in these steps and 64 bits: below 2^36 of them they can't overflow.
SHARED_FLOAT kReportStep = 3.7252902984619140625e-9f; // 2^-28
SHARED_CONST kReportLikeness = 0u; // expected SSIM of a tile of 8 x 8 pixels to the truth
SHARED_CONST kReportError = 1u;    // standard error of a tile's shown luminance
SHARED_CONST kReportSumCount = 2u;
SHARED_CONST kReportCounterCount = 32u;

// What only some scenes require.
SHARED_CONST kWorkAnyHit = 0u;    // hits on surfaces that may let a ray through at this point
SHARED_CONST kWorkLayer = 1u;     // hits on blended surfaces and decals
SHARED_CONST kWorkTurn = 2u;      // rays turned by mirrors, portals, water, glass
SHARED_CONST kWorkSky = 3u;       // looks at a sky
SHARED_CONST kWorkLight = 4u;     // lights tried where all are (rt_numRandomDL 0)
SHARED_CONST kWorkKindCount = 5u;

SHARED_CONST kRayCounterCount = 256u;

struct RtReport {
    uint tileCount;
    uint low[kReportSumCount]; // words of the sums over tiles
    uint high[kReportSumCount];
    uint nonFinite[kReportCounterCount]; // by counter: numbers that are none, and infinities
    uint work[kWorkKindCount];           // by kWork*, modulo 2^32
    uint rays[kRayCounterCount];         // searches for what looking and shadow rays meet; their sum counts
};

// Counts in a buffer of structures of so many 32-bit words, of which those with a bit in `floats` are numbers.
struct RtCheckPush {
    SHARED_ADDRESS words;
    SHARED_ADDRESS report;
    uint wordCount;
    uint wordsPerItem; // at most 32
    uint floats;
    uint counter;
};

SHARED_END
#endif
