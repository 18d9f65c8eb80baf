// Temporal gradient (A-SVGF, section 4.2): by how much the light of a carried sample has changed, what that is relative
// to, and how much of it chance may be. A stratum without one weighs nothing.
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
    vec3 gradient = vec3(0.0);
    if (winner != kNoWinner) {
        uint from = pixelIndex(pixelOfStratum(winnerStratum(winner), winnerFromPixel(winner)));
        uint to = pixelIndex(pixelOfStratum(stratum, winnerToPixel(winner)));
        vec3 old = ColorTable(denoise.previousIrradiance).at[from].rgb;
        vec3 now = ColorTable(denoise.irradiance).at[to].rgb;
        // Lit at the same place, a sample repeats bit for bit. One that has moved may choose another light, or meet a
        // shadow's edge: its change has the whole spread of samples.
        bool moved = loadGuide(denoise.guides, to).position != loadPast(denoise.pasts, to).position;
        float change = luminanceOf(now) - luminanceOf(old);
        if (isFinite(old) && isFinite(now))
            gradient = vec3(change, max(luminanceOf(now), luminanceOf(old)), moved ? change * change : 0.0);
    }
    ColorTable(denoise.gradients[0]).at[stratum] = vec4(gradient, 0.0);
}
