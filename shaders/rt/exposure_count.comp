// Automatic exposure, first pass: a histogram of the picture's luminance before exposure.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "lib/color.glsl"
#include "shared/constants.h"
#include "shared/rt_exposure.h"

layout(local_size_x = 8, local_size_y = 8) in; // as many as bins

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FrameTable { RtFrame value; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ExposureTable { RtExposure value; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ColorTable { vec4 at[]; };
layout(push_constant, scalar) uniform Push { RtExposurePush push; };

shared uint counts[kExposureBinCount];

void main()
{
    counts[gl_LocalInvocationIndex] = 0u;
    barrier();
    uvec2 size = FrameTable(push.frame).value.size;
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (all(lessThan(pixel, size))) {
        vec3 radiance = ColorTable(FrameTable(push.frame).value.radiance).at[pixel.y * size.x + pixel.x].rgb;
        float place = (log2(luminanceOf(radiance)) - kDarkestLog2) / (kBrightestLog2 - kDarkestLog2);
        if (place >= 0.0)
            atomicAdd(counts[min(uint(place * float(kExposureBinCount)), kExposureBinCount - 1u)], 1u);
    }
    barrier();
    uint count = counts[gl_LocalInvocationIndex];
    if (count > 0u)
        atomicAdd(ExposureTable(push.exposure).value.bins[gl_LocalInvocationIndex], count);
}
