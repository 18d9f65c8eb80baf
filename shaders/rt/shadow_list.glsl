// The lists of shadow rays, a tile after the other.
#ifndef Q3RT_RT_SHADOW_LIST_GLSL
#define Q3RT_RT_SHADOW_LIST_GLSL
#include "rt/scene.glsl"
#include "shared/rt_shadow.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer NumberList { uint at[]; };

// First place of a tile's list.
uint listOfTile(uvec2 tile)
{
    uint tilesInRow = (rtFrame.size.x + kShadowTile - 1u) / kShadowTile;
    return (tile.y * tilesInRow + tile.x) * kShadowTilePixels;
}

#endif
