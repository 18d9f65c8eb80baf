// Points and directions from uniform numbers in [0, 1). Pure functions; the tests compare each with closed forms.
#ifndef Q3RT_LIB_SAMPLING_GLSL
#define Q3RT_LIB_SAMPLING_GLSL
#include "shared/constants.h"

// Uniform over the unit disc (Shirley and Chiu 1997, concentric map).
vec2 sampleDisc(float u, float v)
{
    float a = 2.0f * u - 1.0f;
    float b = 2.0f * v - 1.0f;
    if (a == 0.0f && b == 0.0f)
        return vec2(0.0f);
    if (abs(a) > abs(b)) {
        float angle = 0.25f * kPi * (b / a);
        return vec2(a * cos(angle), a * sin(angle));
    }
    float angle = 0.5f * kPi - 0.25f * kPi * (a / b);
    return vec2(b * cos(angle), b * sin(angle));
}

struct Frame {
    vec3 tangent;
    vec3 bitangent;
    vec3 normal;
};

// An orthonormal frame around a unit normal, continuous but at z = 0 (Duff et al. 2017, "Building an Orthonormal Basis,
// Revisited", listing 3).
Frame frameAround(vec3 n)
{
    float s = n.z >= 0.0f ? 1.0f : -1.0f;
    float a = -1.0f / (s + n.z);
    float b = n.x * n.y * a;
    Frame frame;
    frame.tangent = vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    frame.bitangent = vec3(b, s + n.y * n.y * a, -n.y);
    frame.normal = n;
    return frame;
}

vec3 fromFrame(Frame frame, vec3 local)
{
    return frame.tangent * local.x + frame.bitangent * local.y + frame.normal * local.z;
}

// Density cos / pi over the hemisphere of a unit normal (Malley: the disc lifted).
vec3 sampleCosine(vec3 normal, float u, float v)
{
    vec2 disc = sampleDisc(u, v);
    float z = sqrt(max(0.0f, 1.0f - dot(disc, disc)));
    return fromFrame(frameAround(normal), vec3(disc.x, disc.y, z));
}

// Uniform over the cone of directions within acos(cosMax) of a unit axis: density 1 / (2 pi (1 - cosMax)).
// `oneMinusCosMax` is passed as such because 1 - cos of a small angle cancels.
vec3 sampleCone(vec3 axis, float oneMinusCosMax, float u, float v)
{
    float oneMinusZ = u * oneMinusCosMax;
    float sine = sqrt(max(0.0f, oneMinusZ * (2.0f - oneMinusZ)));
    float angle = kTwoPi * v;
    return fromFrame(frameAround(axis), vec3(sine * cos(angle), sine * sin(angle), 1.0f - oneMinusZ));
}

#endif
