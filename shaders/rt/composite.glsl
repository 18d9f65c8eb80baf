// Composite and accumulation: radiance = A x L + B; the mean of all samples of an unchanged view, in 32-bit float.
#ifndef Q3RT_RT_COMPOSITE_GLSL
#define Q3RT_RT_COMPOSITE_GLSL
#include "rt/scene.glsl"

void compositePixel(uvec2 pixelPosition)
{
    uint index = pixelIndex(pixelPosition);
    RtPixel pixel = PixelTable(rtFrame.pixels).at[index];
    vec3 radiance = pixel.albedo * ColorTable(rtFrame.lighting).at[index].rgb + pixel.emission;
    if (rtFrame.sampleNumber > 0u) {
        // Running mean: m += (x - m) / n keeps its relative error below n u.
        vec3 mean = ColorTable(rtFrame.radiance).at[index].rgb;
        radiance = mean + (radiance - mean) / float(rtFrame.sampleNumber + 1u);
    }
    ColorTable(rtFrame.radiance).at[index] = vec4(radiance, 1.0);
}

#endif
