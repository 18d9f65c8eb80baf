// Position and normal of each lit pixel in 16 bytes, for all passes that compare surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/denoise.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, denoise.size)))
        return;
    uint index = pixelIndex(pixel);
    bool lit = PixelTable(denoise.pixels).at[index].lit != 0u;
    GuideTable(denoise.guides).at[index] = RtGuide(PixelTable(denoise.pixels).at[index].seen,
                                                   lit ? packNormal(PixelTable(denoise.pixels).at[index].normal)
                                                       : kNoNormal);
    if (all(lessThan(pixel, denoise.strata)))
        WinnerTable(denoise.winners).at[stratumIndex(pixel)] = kNoWinner;
}
