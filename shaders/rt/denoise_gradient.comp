// Temporal gradient (A-SVGF, section 4.2): by how much the light of a carried sample has changed, and what that is
// relative to. A stratum without one weighs nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/denoise.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, denoise.strata)))
        return;
    uint stratum = stratumIndex(gl_GlobalInvocationID.xy);
    uint winner = WinnerTable(denoise.winners).at[stratum];
    vec2 gradient = vec2(0.0);
    if (winner != kNoWinner) {
        uint from = pixelIndex(pixelOfStratum(winnerStratum(winner), winnerFromPixel(winner)));
        uint to = pixelIndex(pixelOfStratum(stratum, winnerToPixel(winner)));
        vec3 old = ColorTable(denoise.previousIrradiance).at[from].rgb;
        vec3 now = ColorTable(denoise.irradiance).at[to].rgb;
        if (isFinite(old) && isFinite(now))
            gradient = vec2(luminanceOf(now) - luminanceOf(old), max(luminanceOf(now), luminanceOf(old)));
    }
    PairTable(denoise.gradients[0]).at[stratum] = gradient;
}
