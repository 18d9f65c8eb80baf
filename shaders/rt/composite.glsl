// Composite and accumulation: radiance = A x L + B; the means of all samples of an unchanged view, in 32-bit float; and
// the picture made of them. The engine clamps baked light to what shows a texture at its own brightness before it
// multiplies; the same clamp is put on the mean light here, so that bright places keep their texture.
#ifndef Q3RT_RT_COMPOSITE_GLSL
#define Q3RT_RT_COMPOSITE_GLSL
#include "lib/tonemap.glsl"
#include "rt/scene.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MeanTable { RtMean at[]; };

// Running mean: m += (x - m) / n keeps its relative error below n u.
vec3 addToMean(vec3 mean, vec3 value) { return mean + (value - mean) / float(rtFrame.sampleNumber + 1u); }

vec3 exposePicture(vec3 radiance, RtMean mean)
{
    if ((rtFrame.flags & kFrameClampLight) == 0u)
        return rtFrame.exposure * radiance;
    vec3 light = rtFrame.exposure * vec3(mean.albedo.x > 0.0 ? mean.lit.x / mean.albedo.x : 0.0,
                                         mean.albedo.y > 0.0 ? mean.lit.y / mean.albedo.y : 0.0,
                                         mean.albedo.z > 0.0 ? mean.lit.z / mean.albedo.z : 0.0);
    return mean.albedo * clampKeepingHue(light) + rtFrame.exposure * (radiance - mean.lit);
}

void compositePixel(uvec2 pixelPosition)
{
    uint index = pixelIndex(pixelPosition);
    RtPixel pixel = PixelTable(rtFrame.pixels).at[index];
    vec3 light = ColorTable(rtFrame.lighting).at[index].rgb + ColorTable(rtFrame.ambientL).at[index].rgb;
    RtMean mean = RtMean(pixel.albedo, pixel.albedo * light);
    vec3 radiance = mean.lit + pixel.emission;
    if (rtFrame.sampleNumber > 0u) {
        RtMean before = MeanTable(rtFrame.means).at[index];
        mean = RtMean(addToMean(before.albedo, mean.albedo), addToMean(before.lit, mean.lit));
        radiance = addToMean(ColorTable(rtFrame.radiance).at[index].rgb, radiance);
    }
    MeanTable(rtFrame.means).at[index] = mean;
    ColorTable(rtFrame.radiance).at[index] = vec4(radiance, 1.0);
    ColorTable(rtFrame.picture).at[index] = vec4(exposePicture(radiance, mean), 1.0);
}

#endif
