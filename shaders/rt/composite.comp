// Composite and accumulation of one pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/composite.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    if (all(lessThan(gl_GlobalInvocationID.xy, rtFrame.size)))
        compositePixel(gl_GlobalInvocationID.xy);
}
