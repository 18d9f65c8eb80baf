// From radiance (1.0 = a white texture at irradiance 63.75 luxel units) to display values [0, 1].
#ifndef Q3RT_LIB_TONEMAP_GLSL
#define Q3RT_LIB_TONEMAP_GLSL
#include "lib/color.glsl"
#include "shared/rt_output.h"

// The engine's own clamp of baked light: a colour beyond the range is scaled by its largest channel, so hue is kept.
vec3 clampKeepingHue(vec3 color)
{
    float largest = max(color.x, max(color.y, color.z));
    return largest > 1.0f ? color / largest : color;
}

// Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", equation 4: `white` maps to 1.
float reinhardCurve(float x, float white) { return x * (1.0f + x / (white * white)) / (1.0f + x); }

// Hable 2010, "Uncharted 2: HDR Lighting" (GDC): a filmic curve with toe and shoulder, by its published constants.
float filmicShape(float x)
{
    const float shoulder = 0.15f, slope = 0.50f, angle = 0.10f, toe = 0.20f, low = 0.02f, high = 0.30f;
    return (x * (shoulder * x + angle * slope) + toe * low) / (x * (shoulder * x + slope) + toe * high) - low / high;
}

// The published exposure of 2 in front of the shape; `white` maps to 1.
float filmicCurve(float x, float white) { return filmicShape(2.0f * x) / filmicShape(2.0f * white); }

// The curve on the largest channel: hue is kept.
vec3 applyCurve(vec3 color, uint curve, float white)
{
    // Light has been clamped with its hue kept; the sum of all layers is clamped channel by channel, as the engine's
    // blending into bytes does: flames on flames become yellow, not orange.
    if (curve == kCurveClamp)
        return min(color, vec3(1.0f));
    float largest = max(color.x, max(color.y, color.z));
    if (largest <= 0.0f)
        return color;
    float mapped = curve == kCurveFilmic ? filmicCurve(largest, white) : reinhardCurve(largest, white);
    return clampKeepingHue(color * (mapped / largest));
}

// What a display shows of an exposed picture; `linear`: it is in proportion to light.
vec3 displayColor(vec3 color, uint curve, float white, bool linear)
{
    vec3 shown = applyCurve(color, curve, white);
    return linear ? srgbFromLinear(max(shown, vec3(0.0f))) : shown;
}

#endif
