// Arithmetic of the denoiser: packing, edge-stopping weights, blending. Pure functions.
// Schied et al. 2017, "Spatiotemporal Variance-Guided Filtering" (SVGF), sections 4.2 to 4.4; Schied, Peters,
// Dachsbacher 2018, "Gradient Estimation for Real-Time Adaptive Temporal Filtering" (A-SVGF), section 4.
#ifndef Q3RT_LIB_DENOISE_GLSL
#define Q3RT_LIB_DENOISE_GLSL
#include "lib/color.glsl"
#include "lib/octahedral.glsl"
#include "shared/constants.h"

// Unit normals in 32 bits. packSnorm2x16 never gives -32768, which marks pixels that take no light or have no past.
const uint kNoNormal = 0x80008000u;
const uint kNoPast = 0x80008001u;

uint packNormal(vec3 n)
{
    return packSnorm2x16(octahedralOf(n));
}

vec3 unpackNormal(uint bits)
{
    return fromOctahedral(unpackSnorm2x16(bits));
}

// A sample carried from a stratum of the previous frame to a pixel of a stratum of this one: 24 bits of the stratum's
// number (pictures of 150 million pixels), 4 of each pixel's number in its stratum.
uint packWinner(uint fromStratum, uint fromPixel, uint toPixel)
{
    return fromStratum << 8u | fromPixel << 4u | toPixel;
}
uint winnerStratum(uint winner) { return winner >> 8u; }
uint winnerFromPixel(uint winner) { return winner >> 4u & 15u; }
uint winnerToPixel(uint winner) { return winner & 15u; }

// Normals of one surface in neighbouring pixels: within 25 degrees.
const float kSameNormalCosine = 0.9f;
// Neighbouring samples of one surface lie at most this many pixels apart: a tap two rows away, each jittered by one.
const float kSameSurfacePixels = 4.0f;

// Is `other` the surface of `point`? `footprint`: width of a pixel at the point, qu; `cosine`: between normal and view.
bool isSameSurface(vec3 point, vec3 normal, vec3 other, vec3 otherNormal, float footprint, float cosine)
{
    vec3 apart = other - point;
    float reach = kSameSurfacePixels * footprint / max(cosine, kGrazingCosine);
    return abs(dot(normal, apart)) <= footprint && dot(apart, apart) <= reach * reach &&
           dot(normal, otherNormal) >= kSameNormalCosine;
}

// Edge-stopping weights (SVGF, section 4.4). A plane one pixel away counts 1/e; normals with exponent 128.
float planeWeight(float distance, float footprint) { return exp(-abs(distance) / footprint); }

float normalWeight(float cosine)
{
    float w = max(cosine, 0.0f);
    w *= w;
    w *= w;
    w *= w;
    w *= w;
    w *= w;
    w *= w;
    return w * w;
}

// Differences of this many standard deviations count 1/e (SVGF, sigma_l).
const float kLuminanceSigmas = 4.0f;
// Differences that no display of 8 bits shows, a quarter of its step, are none.
const float kInvisibleLuminance = 1.0f / 1020.0f;

// Both weights of a tap in one exponential: how many planes' widths and how many times the tolerated difference of
// luminance it is away. `variance`: of the difference. The filter is bound by arithmetic: no root, no division here.
float tapWeight(float planeDistance, float inverseFootprint, float difference, float variance)
{
    const float invisible2 = kInvisibleLuminance * kInvisibleLuminance;
    float tolerated2 = kLuminanceSigmas * kLuminanceSigmas * variance + invisible2;
    return exp(-abs(planeDistance) * inverseFootprint - abs(difference) * inversesqrt(tolerated2));
}

// Variance of a mean of n samples from their moments; n - 1 because the mean is theirs. n >= 2.
float varianceOfMean(vec2 moments, float n) { return max(moments.y - moments.x * moments.x, 0.0f) / (n - 1.0f); }

// Relative changes from this on say that nothing of the old light is left to use.
const float kFullChange = 0.1f;

// Chance is taken to make changes of so many standard deviations: what is above it has a cause.
const float kChanceSigmas = 1.0f;

// How much of the history is to be dropped: A-SVGF, equation 4, steeper. A mean that forgets a share a of itself in
// each frame lags a light that changes by g a frame by g / a and keeps noise in proportion to a; the sum of both
// squares is least where a^3 goes with g^2. The gradient of an unchanged point is exactly 0: no steady light loses any.
// `gradient`: change of luminance, what it is relative to, variance of the change by chance.
float historyLoss(vec3 gradient)
{
    float change = abs(gradient.x) - kChanceSigmas * sqrt(gradient.z);
    if (gradient.y <= 0.0f || change <= 0.0f)
        return 0.0f;
    return min(pow(change / (kFullChange * gradient.y), 2.0f / 3.0f), 1.0f);
}

// Share of the new sample in the mean: 1/n while nothing changes, more where the history is wrong.
float blendFactor(float historySamples, float loss) { return max(1.0f / (historySamples + 1.0f), loss); }

// One row of the 3 x 3 kernel, by distance from the centre in taps.
float tentKernel(int distance) { return distance == 0 ? 0.5f : 0.25f; }

#endif
