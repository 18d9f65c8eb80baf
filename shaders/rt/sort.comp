// The shadow rays of a tile listed in the order of their lights, so that those traced side by side go the same way: a
// counting sort in shared memory. Rays of one light come block by block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/shadow_list.glsl"

layout(local_size_x = kSortGroup, local_size_y = kSortGroup) in;

const uint kBlocksInRow = kShadowTile / kSortGroup;
const uint kBlocks = kBlocksInRow * kBlocksInRow;

shared uint binEnds[kShadowBins];

uvec2 inTile(uint block)
{
    return gl_LocalInvocationID.xy + kSortGroup * uvec2(block % kBlocksInRow, block / kBlocksInRow);
}

uint binAt(uvec2 pixelPosition)
{
    if (any(greaterThanEqual(pixelPosition, rtFrame.size)))
        return kNoShadowRay;
    return NumberList(rtFrame.shadowBins).at[pixelIndex(pixelPosition)];
}

// Inclusive sums over the bins (Hillis and Steele 1986).
void sumBins(uint own)
{
    for (uint step = 1u; step < kShadowBins; step *= 2u) {
        uint before = own >= step ? binEnds[own - step] : 0u;
        barrier();
        binEnds[own] += before;
        barrier();
    }
}

void main()
{
    uint own = gl_LocalInvocationIndex;
    uvec2 corner = gl_WorkGroupID.xy * kShadowTile;
    binEnds[own] = 0u;
    barrier();
    for (uint block = 0u; block < kBlocks; ++block) {
        uint bin = binAt(corner + inTile(block));
        if (bin != kNoShadowRay)
            atomicAdd(binEnds[bin], 1u);
    }
    barrier();
    uint ofOwnBin = binEnds[own];
    sumBins(own);
    uint count = binEnds[kShadowBins - 1u];
    barrier();
    // From now on where the bin's next ray goes.
    binEnds[own] -= ofOwnBin;
    barrier();
    uint list = listOfTile(gl_WorkGroupID.xy);
    NumberList order = NumberList(rtFrame.shadowOrder);
    for (uint block = 0u; block < kBlocks; ++block) {
        uvec2 at = inTile(block);
        uint bin = binAt(corner + at);
        if (bin != kNoShadowRay)
            order.at[list + atomicAdd(binEnds[bin], 1u)] = at.y * kShadowTile + at.x;
    }
    for (uint place = own; place < kShadowTilePixels; place += kShadowBins)
        if (place >= count)
            order.at[list + place] = kNoShadowRay;
}
