// What accumulation keeps of a pixel: one text for C++ and GLSL, scalar layout.
#ifndef Q3RT_SHARED_RT_SUMS_H
#define Q3RT_SHARED_RT_SUMS_H
#include "types.h"
SHARED_BEGIN

// Sums over all plain samples of an unchanged view, compensated: see lib/sums.glsl. Albedo and A x L are apart for a
// picture that clamps light and not its product with a texture.
struct RtSums {
    vec3 albedo;
    vec3 albedoLow;
    vec3 lit;
    vec3 litLow;
    vec3 radiance;
    vec3 radianceLow;
    float luminance; // of radiance: mean, and sum of squared distances from it
    float luminanceSquares;
};

SHARED_END
#endif
