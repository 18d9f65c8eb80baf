// Variance of each pixel's mean light: from its own moments over frames, averaged with its neighbours', or while these
// are too few from the moments of a 7 x 7 neighbourhood on the same surface (SVGF, section 4.2).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rt/denoise.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const int kSpatialReach = 3; // pixels to each side

float spatialVariance(uvec2 pixel, RtGuide center, float samples)
{
    vec3 normal = unpackNormal(center.normal);
    float footprint = denoise.pixelTangent * length(center.position - denoise.camera.eye);
    vec2 moments = vec2(0.0);
    float weightSum = 0.0;
    for (int y = -kSpatialReach; y <= kSpatialReach; ++y)
        for (int x = -kSpatialReach; x <= kSpatialReach; ++x) {
            ivec2 tap = ivec2(pixel) + ivec2(x, y);
            if (!isInside(tap))
                continue;
            uint index = pixelIndex(uvec2(tap));
            RtGuide guide = loadGuide(denoise.guides, index);
            if (guide.normal == kNoNormal)
                continue;
            float weight = normalWeight(dot(normal, unpackNormal(guide.normal))) *
                           planeWeight(dot(normal, guide.position - center.position), footprint);
            moments += weight * PairTable(denoise.moments).at[index];
            weightSum += weight;
        }
    moments /= weightSum;
    return max(moments.y - moments.x * moments.x, 0.0) / samples;
}

// Neighbours with too few samples are left out; the pixel itself has enough.
float temporalVariance(uvec2 pixel)
{
    float sum = 0.0, weightSum = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 tap = ivec2(pixel) + ivec2(x, y);
            if (!isInside(tap))
                continue;
            uint index = pixelIndex(uvec2(tap));
            float samples = ColorTable(denoise.light).at[index].w;
            if (samples < kTemporalVarianceSamples)
                continue;
            float weight = tentKernel(x) * tentKernel(y);
            sum += weight * varianceOfMean(PairTable(denoise.moments).at[index], samples);
            weightSum += weight;
        }
    return sum / weightSum;
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, denoise.size)))
        return;
    uint index = pixelIndex(pixel);
    vec4 light = ColorTable(denoise.light).at[index];
    RtGuide guide = loadGuide(denoise.guides, index);
    float variance = 0.0;
    if (guide.normal != kNoNormal && light.w < kTemporalVarianceSamples)
        variance = spatialVariance(pixel, guide, light.w);
    else if (guide.normal != kNoNormal)
        variance = temporalVariance(pixel);
    ColorTable(denoise.filtered[0]).at[index] = vec4(light.rgb, variance);
}
