// The pixel that a projected sample has won shows that sample's surface point, lit with that sample's random numbers:
// the direct stage repeats the previous frame's work there. Material and glow stay the pixel's own.
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
    if (winner == kNoWinner)
        return;
    uint from = pixelIndex(pixelOfStratum(winnerStratum(winner), winnerFromPixel(winner)));
    RtPixel old = loadPixel(denoise.previousPixels, from);
    RtGuide oldGuide = loadGuide(denoise.previousGuides, from);
    RtMotion motion = MotionTable(denoise.motionToCurrent).at[old.instance];
    HitPoint point =
        movePoint(motion, old.triangle, unpackUnorm2x16(old.barycentric), HitPoint(old.position, old.error));
    vec3 seen = (old.lit & kLitTurned) != 0u ? oldGuide.position : point.position;
    vec3 normal = moveDirection(motion, old.normal);
    uint index = pixelIndex(pixelOfStratum(stratum, winnerToPixel(winner)));
    RtPixel pixel = loadPixel(denoise.pixels, index);
    pixel.position = point.position;
    pixel.lit = old.lit;
    pixel.error = point.error;
    pixel.keyPixel = old.keyPixel;
    pixel.normal = normal;
    pixel.keyFrame = old.keyFrame;
    pixel.geometricNormal = moveDirection(motion, old.geometricNormal);
    storePixel(denoise.pixels, index, pixel);
    storeGuide(denoise.guides, index, RtGuide(seen, packNormal(normal)));
    storePast(denoise.pasts, index, RtPast(oldGuide.position, oldGuide.normal));
}
