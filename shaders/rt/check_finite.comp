// Counts the numbers of a buffer that are none, or infinite: an exponent of ones only.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "shared/rt_report.h"

layout(local_size_x = 64) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer WordTable { uint at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ReportTable { RtReport value; };
layout(push_constant, scalar) uniform Push { RtCheckPush push; };

void main()
{
    uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint count = 0u;
    for (uint i = gl_GlobalInvocationID.x; i < push.wordCount; i += stride)
        if ((push.floats >> i % push.wordsPerItem & 1u) != 0u)
            count += (WordTable(push.words).at[i] & 0x7f800000u) == 0x7f800000u ? 1u : 0u;
    if (count > 0u)
        atomicAdd(ReportTable(push.report).value.nonFinite[push.counter], count);
}
