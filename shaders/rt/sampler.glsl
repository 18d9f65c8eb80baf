// Numbers for what a pixel averages over frames: a low-discrepancy sequence over the frames, the same for all pixels,
// shifted in each pixel by blue noise, so that neighbours err in different directions (Georgiev and Fajardo 2016,
// "Blue-Noise Dithered Sampling"). Over the seeds every number is uniform and independent of the pixel.
#ifndef Q3RT_RT_SAMPLER_GLSL
#define Q3RT_RT_SAMPLER_GLSL
#include "lib/low_discrepancy.glsl"
#include "lib/random.glsl"
#include "rt/scene.glsl"
#include "shared/rt_noise.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer NoiseTable { RtNoise at[]; };

// Ranks of the masks at a pixel as fractions of 32 bits; every dimension has another part of the masks.
uvec4 blueNoise(uvec2 pixel, uint dimension)
{
    uvec2 at = (pixel + (dimension * uvec2(0xc13fa9a9u, 0x91e10da5u) >> 26u)) % kBlueNoiseSide;
    RtNoise noise = NoiseTable(rtFrame.noise).at[at.y * kBlueNoiseSide + at.x];
    uvec4 ranks = uvec4(noise.xy & 0xffffu, noise.xy >> 16u, noise.zw & 0xffffu, noise.zw >> 16u);
    return ranks << (32u - kBlueNoiseBits);
}

// Four numbers of 32 bits for one dimension; x and y belong together, z and w too. `key`: randomKey().
uvec4 sampleBits(uvec4 key, uint dimension)
{
    if ((rtFrame.flags & kFrameBlueNoise) == 0u)
        return randomBits(key, dimension);
    uvec4 one = hashPcg4d(uvec4(dimension, key.w, 1u, 0u)), two = hashPcg4d(uvec4(dimension, key.w, 2u, 0u));
    uvec4 points = uvec4(lowDiscrepancyPoint(key.z, one.xyz), lowDiscrepancyPoint(key.z, two.xyz));
    return points + blueNoise(key.xy, dimension);
}

vec4 sampleNumbers(uvec4 key, uint dimension) { return unitFloats(sampleBits(key, dimension)); }

#endif
