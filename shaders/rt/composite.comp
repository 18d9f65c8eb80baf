// Composite of one pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/composite.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, rtFrame.size)))
        return;
    uint index = pixelIndex(gl_GlobalInvocationID.xy);
    Composed composed = composePixel(index, rtFrame.lighting);
    if ((rtFrame.flags & kFrameKeepRadiance) != 0u)
        ColorTable(rtFrame.radiance).at[index] = vec4(composed.radiance, 1.0);
    ColorTable(rtFrame.picture).at[index] = vec4(exposePicture(composed), 1.0);
}
