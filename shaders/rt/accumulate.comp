// Adds the frame's plain sample of one pixel to the mean of an unchanged view.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/accumulate.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, rtFrame.size)))
        return;
    uint index = pixelIndex(gl_GlobalInvocationID.xy);
    RtSums sums = RtSums(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0);
    if (rtFrame.sampleNumber > 0u)
        sums = SumTable(rtFrame.sums).at[index];
    Composed composed = composePixel(index, rtFrame.irradiance);
    addCompensated(sums.albedo, sums.albedoLow, composed.albedo);
    addCompensated(sums.lit, sums.litLow, composed.lit);
    addCompensated(sums.radiance, sums.radianceLow, composed.radiance);
    addToSpread(sums.luminance, sums.luminanceSquares, luminanceOf(composed.radiance), sampleCount());
    SumTable(rtFrame.sums).at[index] = sums;
    Composed mean = meanOf(sums);
    ColorTable(rtFrame.radiance).at[index] = vec4(mean.radiance, 1.0);
    ColorTable(rtFrame.reference).at[index] = vec4(exposePicture(mean), 1.0);
}
