// Blend equation of the shader language: source * factor + destination * factor, one equation for all, ADD only.
// The frame has no alpha of its own: destination alpha reads 1. Colours in [0, 1].
#ifndef Q3RT_LIB_BLEND_GLSL
#define Q3RT_LIB_BLEND_GLSL
#include "shared/stage.h"

// The factor that multiplies the source or the destination colour.
vec3 blendFactor(uint factor, vec4 source, vec3 destination)
{
    if (factor == kBlendOne || factor == kBlendDstAlpha)
        return vec3(1.0f);
    if (factor == kBlendSrcColor)
        return vec3(source);
    if (factor == kBlendOneMinusSrcColor)
        return vec3(1.0f) - vec3(source);
    if (factor == kBlendDstColor)
        return destination;
    if (factor == kBlendOneMinusDstColor)
        return vec3(1.0f) - destination;
    if (factor == kBlendSrcAlpha)
        return vec3(source.a);
    if (factor == kBlendOneMinusSrcAlpha)
        return vec3(1.0f - source.a);
    // kBlendZero; kBlendOneMinusDstAlpha = 1 - 1; kBlendSrcAlphaSaturate = min(source alpha, 1 - 1)
    return vec3(0.0f);
}

// What an 8-bit frame buffer holds after the blend, up to its rounding.
vec3 blendColors(uint sourceFactor, uint destinationFactor, vec4 source, vec3 destination)
{
    vec3 result = vec3(source) * blendFactor(sourceFactor, source, destination) +
                  destination * blendFactor(destinationFactor, source, destination);
    return clamp(result, vec3(0.0f), vec3(1.0f));
}
#endif
