// Random numbers without state: a hash of (pixel, frame, dimension, seed), so that a fixed seed gives the same frame
// bit for bit on any back end and in any order of evaluation. Hash: "pcg4d" of Jarzynski and Olano 2020, "Hash
// Functions for GPU Rendering" (JCGT 9, 3), section 4.2: one LCG step, two rounds of multiply-add across the
// components with a shift-xor between them.
#ifndef Q3RT_LIB_RANDOM_GLSL
#define Q3RT_LIB_RANDOM_GLSL


uvec4 hashPcg4d(uvec4 v)
{
    v = v * 1664525u + uvec4(1013904223u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v.x = v.x ^ (v.x >> 16u);
    v.y = v.y ^ (v.y >> 16u);
    v.z = v.z ^ (v.z >> 16u);
    v.w = v.w ^ (v.w >> 16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// 24 bits to [0, 1): every value is a binary32 number and 1 is never reached.
float unitFloat(uint bits) { return float(bits >> 8u) * 5.9604644775390625e-8f; }

// Four independent numbers of one dimension, 32 bits each. Dimensions are given out by the stages (kDimension*).
uvec4 randomBits(uvec4 key, uint dimension)
{
    return hashPcg4d(uvec4(key.x, key.y, key.z, key.w ^ (dimension * 2654435769u)));
}

vec4 unitFloats(uvec4 bits)
{
    return vec4(unitFloat(bits.x), unitFloat(bits.y), unitFloat(bits.z), unitFloat(bits.w));
}

vec4 randomNumbers(uvec4 key, uint dimension) { return unitFloats(randomBits(key, dimension)); }

#endif
