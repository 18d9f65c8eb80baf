// Colours as numbers. Pure functions.
#ifndef Q3RT_LIB_COLOR_GLSL
#define Q3RT_LIB_COLOR_GLSL

// Rec. 709 weights, as of display values; only their being positive and of sum 1 matters.
float luminanceOf(vec3 color) { return dot(color, vec3(0.2126f, 0.7152f, 0.0722f)); }

// IEC 61966-2-1: display values of sRGB and the light that they stand for, each channel in [0, 1].
float linearFromSrgb(float v) { return v <= 0.04045f ? v / 12.92f : pow((v + 0.055f) / 1.055f, 2.4f); }
float srgbFromLinear(float v) { return v <= 0.0031308f ? v * 12.92f : 1.055f * pow(v, 1.0f / 2.4f) - 0.055f; }
vec3 linearFromSrgb(vec3 c) { return vec3(linearFromSrgb(c.x), linearFromSrgb(c.y), linearFromSrgb(c.z)); }
vec3 srgbFromLinear(vec3 c) { return vec3(srgbFromLinear(c.x), srgbFromLinear(c.y), srgbFromLinear(c.z)); }

#endif
