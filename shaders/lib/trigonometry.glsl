// Angles to a few roundings. Vulkan promises no more of sin and cos than 2^-11 (absolute) and of atan than 4096 ulp:
// too little where an angle is small and its relative error counts.
#ifndef Q3RT_LIB_TRIGONOMETRY_GLSL
#define Q3RT_LIB_TRIGONOMETRY_GLSL
#include "shared/constants.h"

// Angle of (x, y) from the x axis, y >= 0: in [0, pi]. Halved twice, so that the series of atan at most 0.415 is left:
// its first missing term is 4.4e-8 of the result. 0 for (0, 0).
float angleOf(float y, float x)
{
    if (y == 0.0f)
        return x >= 0.0f ? 0.0f : kPi;
    float r = sqrt(x * x + y * y);
    float halfTangent = x >= 0.0f ? y / (x + r) : y / (r - x);
    float t = halfTangent / (1.0f + sqrt(1.0f + halfTangent * halfTangent));
    float z = t * t;
    float series = 1.0f / 13.0f - z * (1.0f / 15.0f);
    series = 1.0f / 9.0f - z * (1.0f / 11.0f - z * series);
    series = 1.0f / 5.0f - z * (1.0f / 7.0f - z * series);
    float angle = 4.0f * t * (1.0f - z * (1.0f / 3.0f - z * series));
    return x >= 0.0f ? angle : kPi - angle;
}

// (cos, sin) of an angle in [0, pi]. Taylor series on [0, pi/2]: the first missing terms are 5.7e-8 of the sine and
// 6.4e-9.
vec2 cosineSine(float angle)
{
    float x = angle > 0.5f * kPi ? kPi - angle : angle;
    float z = x * x;
    float odd = 1.0f - z * (1.0f / 72.0f) * (1.0f - z * (1.0f / 110.0f));
    odd = 1.0f - z * (1.0f / 6.0f) * (1.0f - z * (1.0f / 20.0f) * (1.0f - z * (1.0f / 42.0f) * odd));
    float even = 1.0f - z * (1.0f / 90.0f) * (1.0f - z * (1.0f / 132.0f));
    even = 1.0f - z * (1.0f / 12.0f) * (1.0f - z * (1.0f / 30.0f) * (1.0f - z * (1.0f / 56.0f) * even));
    even = 1.0f - z * 0.5f * even;
    return vec2(angle > 0.5f * kPi ? -even : even, x * odd);
}

#endif
