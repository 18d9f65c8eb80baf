// Shadow rays on their way from the stage that chooses lights to the one that traces. Scalar layout.
#ifndef Q3RT_SHARED_RT_SHADOW_H
#define Q3RT_SHARED_RT_SHADOW_H
#include "types.h"
SHARED_BEGIN

// Rays are listed in tiles of this side, pixels, in the order of their lights.
SHARED_CONST kShadowTile = 64u;
SHARED_CONST kShadowTilePixels = kShadowTile * kShadowTile;
// Work groups of the stage that sorts: one a tile, of this side; an invocation takes one pixel of each of its blocks.
SHARED_CONST kSortGroup = 16u;
// Bins that a tile's rays are sorted into, one an invocation.
SHARED_CONST kShadowBins = kSortGroup * kSortGroup;

// One a pixel, row by row; read where a tile's list names its pixel. A GPU's sector of memory.
struct RtShadowRay {
    vec3 origin;
    uint reserved;
    vec3 direction; // to the sampled point: t = 1 there
    uint fromSky;   // 1: it must end on a sky
};

// Of a pixel without a ray, and of a place in a tile's list that has none.
SHARED_CONST kNoShadowRay = 0xffffffffu;

SHARED_END
#endif
