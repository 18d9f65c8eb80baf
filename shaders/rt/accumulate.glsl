// The sums of plain samples.
#ifndef Q3RT_RT_ACCUMULATE_GLSL
#define Q3RT_RT_ACCUMULATE_GLSL
#include "lib/denoise.glsl"
#include "lib/sums.glsl"
#include "rt/composite.glsl"
#include "shared/rt_sums.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SumTable { RtSums at[]; };

float sampleCount() { return float(rtFrame.sampleNumber + 1u); }

Composed meanOf(RtSums sums)
{
    float n = sampleCount();
    return Composed((sums.albedo - sums.albedoLow) / n, (sums.lit - sums.litLow) / n,
                    (sums.radiance - sums.radianceLow) / n);
}

#endif
