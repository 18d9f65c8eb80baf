// One level of the edge-avoiding a-trous wavelet filter of light and its variance (SVGF, section 4.4).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/denoise.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const int kReach = 2; // taps to each side

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uvec2 size = denoise.size;
    if (any(greaterThanEqual(pixel, size)))
        return;
    GuideTable guides = GuideTable(denoise.guides);
    ColorTable from = ColorTable(denoise.filtered[push.level & 1u]);
    uint index = pixel.y * size.x + pixel.x;
    RtGuide center = guides.at[index];
    vec4 light = from.at[index];
    if (center.normal != kNoNormal) {
        vec3 normal = unpackNormal(center.normal);
        float footprint = denoise.pixelTangent * length(center.position - denoise.camera.eye);
        float luminance = luminanceOf(light.rgb);
        int step = 1 << push.level;
        float weightSum = splineKernel(0) * splineKernel(0);
        vec4 sum = light * vec4(vec3(weightSum), weightSum * weightSum);
        for (int y = -kReach; y <= kReach; ++y)
            for (int x = -kReach; x <= kReach; ++x) {
                ivec2 tap = ivec2(pixel) + ivec2(x, y) * step;
                if ((x == 0 && y == 0) || any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, ivec2(size))))
                    continue;
                uint tapIndex = uint(tap.y) * size.x + uint(tap.x);
                RtGuide guide = guides.at[tapIndex];
                if (guide.normal == kNoNormal)
                    continue;
                vec4 tapLight = from.at[tapIndex];
                // The variance of the difference is the sum of both: the weight is the same both ways, so light that a
                // pixel gives to its neighbour comes back, and the mean is kept.
                float weight = splineKernel(x) * splineKernel(y) *
                               normalWeight(dot(normal, unpackNormal(guide.normal))) *
                               planeWeight(dot(normal, guide.position - center.position), footprint) *
                               luminanceWeight(luminanceOf(tapLight.rgb) - luminance, light.w + tapLight.w);
                sum += tapLight * vec4(vec3(weight), weight * weight);
                weightSum += weight;
            }
        light = sum / vec4(vec3(weightSum), weightSum * weightSum);
    }
    ColorTable(denoise.filtered[push.level + 1u & 1u]).at[index] = light;
}
