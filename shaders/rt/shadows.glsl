// Shadows of the chosen lights: each ray of a tile's list takes its pixel's light away if something stands in its way.
#ifndef Q3RT_RT_SHADOWS_GLSL
#define Q3RT_RT_SHADOWS_GLSL
#include "rt/shadow.glsl"
#include "rt/shadow_list.glsl"
#include "rt/work.glsl"

// `place`: one of the tile's pixels, that stands for a place in its list: those of 8x8 pixels are neighbours in it.
void traceListed(uvec2 place)
{
    uvec2 tile = place / kShadowTile, inTile = place % kShadowTile, block = inTile / 8u;
    uint number = (block.y * (kShadowTile / 8u) + block.x) * 64u + (inTile.y & 7u) * 8u + (inTile.x & 7u);
    uint listed = NumberList(rtFrame.shadowOrder).at[listOfTile(tile) + number];
    if (listed == kNoShadowRay)
        return;
    uvec2 pixel = tile * kShadowTile + uvec2(listed % kShadowTile, listed / kShadowTile);
    uint index = pixelIndex(pixel);
    RtShadowRay ray = loadShadowRay(rtFrame.shadowRays, index);
    if (!isOpen(ray.origin, ray.direction, ray.fromSky != 0u))
        ColorTable(rtFrame.irradiance).at[index] = vec4(0.0, 0.0, 0.0, 1.0);
    reportRays(pixel);
}

#endif
