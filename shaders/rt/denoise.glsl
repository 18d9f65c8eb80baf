// The denoiser's tables and what its passes share.
#ifndef Q3RT_RT_DENOISE_GLSL
#define Q3RT_RT_DENOISE_GLSL
#include "lib/denoise.glsl"
#include "lib/random.glsl"
#include "rt/motion.glsl"
#include "shared/rt_denoise.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer DenoiseTable { RtDenoise value; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ColorTable { vec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer PairTable { vec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer WinnerTable { uint at[]; };

layout(push_constant, scalar) uniform Push { RtDenoisePush push; };

#define denoise DenoiseTable(push.denoise).value

uint pixelIndex(uvec2 pixel) { return pixel.y * denoise.size.x + pixel.x; }
uint stratumIndex(uvec2 stratum) { return stratum.y * denoise.strata.x + stratum.x; }

// Pixel number i of a stratum, row by row. It may lie outside the picture.
uvec2 pixelOfStratum(uint stratum, uint i)
{
    uvec2 corner = uvec2(stratum % denoise.strata.x, stratum / denoise.strata.x) * kStratumPixels;
    return corner + uvec2(i % kStratumPixels, i / kStratumPixels);
}

bool isInside(ivec2 pixel)
{
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(denoise.size)));
}

bool isFinite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }

#endif
