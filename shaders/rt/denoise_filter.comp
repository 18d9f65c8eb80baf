// One level of the edge-avoiding a-trous wavelet filter of light and its variance (SVGF, section 4.4), with 3 x 3 taps:
// 5 x 5 take 2.5 times as long and come no closer to the reference once a few frames are in the mean.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/denoise.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const int kReach = 1; // taps to each side

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uvec2 size = denoise.size;
    if (any(greaterThanEqual(pixel, size)))
        return;
    ColorTable from = ColorTable(denoise.filtered[push.level & 1u]);
    uint index = pixel.y * size.x + pixel.x;
    RtGuide center = loadGuide(denoise.guides, index);
    vec4 light = from.at[index];
    if (center.normal != kNoNormal) {
        vec3 normal = unpackNormal(center.normal);
        float inverseFootprint = 1.0 / (denoise.pixelTangent * length(center.position - denoise.camera.eye));
        float luminance = luminanceOf(light.rgb);
        int step = 1 << push.level;
        float weightSum = tentKernel(0) * tentKernel(0);
        vec4 sum = light * vec4(vec3(weightSum), weightSum * weightSum);
        for (int y = -kReach; y <= kReach; ++y)
            for (int x = -kReach; x <= kReach; ++x) {
                ivec2 tap = ivec2(pixel) + ivec2(x, y) * step;
                if ((x == 0 && y == 0) || any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, ivec2(size))))
                    continue;
                uint tapIndex = uint(tap.y) * size.x + uint(tap.x);
                RtGuide guide = loadGuide(denoise.guides, tapIndex);
                if (guide.normal == kNoNormal)
                    continue;
                vec4 tapLight = from.at[tapIndex];
                // The variance of the difference is the sum of both: the weight is the same both ways, so light that a
                // pixel gives to its neighbour comes back, and the mean is kept.
                float weight = tentKernel(x) * tentKernel(y) *
                               tapWeight(dot(normal, guide.position - center.position), inverseFootprint,
                                         luminanceOf(tapLight.rgb) - luminance, light.w + tapLight.w);
                // Most surfaces are flat: equal bits need no unpacking.
                if (guide.normal != center.normal)
                    weight *= normalWeight(dot(normal, unpackNormal(guide.normal)));
                sum += tapLight * vec4(vec3(weight), weight * weight);
                weightSum += weight;
            }
        light = sum / vec4(vec3(weightSum), weightSum * weightSum);
    }
    ColorTable(denoise.filtered[push.level + 1u & 1u]).at[index] = light;
}
