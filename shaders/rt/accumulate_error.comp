// How good the mean of plain samples is by now: of each tile the expected likeness to the truth and the standard error,
// of luminance as it is shown.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "lib/report.glsl"
#include "rt/accumulate.glsl"
#include "shared/rt_report.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ReportTable { RtReport value; };

#define report ReportTable(rtFrame.report).value

shared float shown[64];
shared float noise[64];

float shownLuminance(vec3 picture)
{
    return luminanceOf(displayColor(picture, rtFrame.curve, rtFrame.curveWhite, (rtFrame.flags & kFrameLinear) != 0u));
}

// Luminance as shown, and the variance of its mean: the picture's, times the square of the curve's slope there.
void measurePixel(uint index, out float luminance, out float variance)
{
    const float step = 1.0 / 64.0;
    vec3 picture = ColorTable(rtFrame.reference).at[index].rgb;
    luminance = shownLuminance(picture);
    variance = 0.0;
    float radiance = SumTable(rtFrame.sums).at[index].luminance;
    if (radiance <= 0.0)
        return;
    float n = sampleCount();
    float relative2 = SumTable(rtFrame.sums).at[index].luminanceSquares / (n * (n - 1.0) * radiance * radiance);
    float slope = (luminance - shownLuminance(picture * (1.0 - step))) / step;
    variance = relative2 * slope * slope;
}

void addToReport(uint sum, float value)
{
    uint steps = uint(clamp(value, 0.0, 1.0) / kReportStep);
    if (atomicAdd(report.low[sum], steps) > 0xffffffffu - steps)
        atomicAdd(report.high[sum], 1u);
}

void main()
{
    uvec2 pixel = min(gl_GlobalInvocationID.xy, rtFrame.size - 1u);
    measurePixel(pixelIndex(pixel), shown[gl_LocalInvocationIndex], noise[gl_LocalInvocationIndex]);
    barrier();
    if (gl_LocalInvocationIndex != 0u)
        return;
    float mean = 0.0, squares = 0.0, variance = 0.0;
    for (uint i = 0u; i < 64u; ++i) {
        mean += shown[i] / 64.0;
        variance += noise[i] / 64.0;
    }
    for (uint i = 0u; i < 64u; ++i)
        squares += (shown[i] - mean) * (shown[i] - mean) / 64.0;
    atomicAdd(report.tileCount, 1u);
    addToReport(kReportLikeness, expectedLikeness(squares, variance));
    addToReport(kReportError, sqrt(variance));
}
