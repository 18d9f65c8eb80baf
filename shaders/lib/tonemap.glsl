// From radiance (1.0 = a white texture at irradiance 63.75 luxel units) to display values [0, 1].
#ifndef Q3RT_LIB_TONEMAP_GLSL
#define Q3RT_LIB_TONEMAP_GLSL

// The engine's own clamp of baked light: a colour beyond the range is scaled by its largest channel, so hue is kept.
vec3 clampKeepingHue(vec3 color)
{
    float largest = max(color.x, max(color.y, color.z));
    return largest > 1.0f ? color / largest : color;
}

// A filmic shoulder (Reinhard et al. 2002, "Photographic Tone Reproduction", eq. 4) on the largest channel: hue is
// kept, `white` maps to 1.
vec3 reinhardKeepingHue(vec3 color, float white)
{
    float largest = max(color.x, max(color.y, color.z));
    float mapped = largest * (1.0f + largest / (white * white)) / (1.0f + largest);
    return largest > 0.0f ? clampKeepingHue(color * (mapped / largest)) : color;
}

#endif
