// Arithmetic of temporal anti-aliasing. Pure functions.
// Salvi 2016, "An Excursion in Temporal Supersampling" (variance clipping); Karis 2014, "High Quality Temporal
// Supersampling" (clipping toward the mean, YCoCg). Means are of radiance itself, not of tone-mapped values: the
// denoiser has tamed bright samples already, and the result tends to the reference.
#ifndef Q3RT_LIB_TAA_GLSL
#define Q3RT_LIB_TAA_GLSL

// Luma, orange-blue, green-magenta: axes along which the colours of a small neighbourhood spread.
vec3 yCoCgFromRgb(vec3 c)
{
    return vec3(0.25f * c.x + 0.5f * c.y + 0.25f * c.z, 0.5f * (c.x - c.z), 0.5f * c.y - 0.25f * (c.x + c.z));
}

vec3 rgbFromYCoCg(vec3 c)
{
    float base = c.x - c.z;
    return vec3(base + c.y, c.x + c.z, base - c.y);
}

// Half the size of the box of plausible colours, in standard deviations of the neighbourhood: where the picture stands
// still, the jitter alone moves colours so far.
const float kStillSigmas = 1.5f;
const float kMovingSigmas = 1.0f;

// `color` moved toward `mean` until it lies in the box mean +- extent.
vec3 clipToBox(vec3 color, vec3 mean, vec3 extent)
{
    vec3 apart = color - mean;
    vec3 size = abs(apart);
    float share = 1.0f;
    if (size.x > extent.x)
        share = min(share, extent.x / size.x);
    if (size.y > extent.y)
        share = min(share, extent.y / size.y);
    if (size.z > extent.z)
        share = min(share, extent.z / size.z);
    return mean + apart * share;
}

// Catmull-Rom weights of the four texels around a place, `t` in [0, 1) from the second.
vec4 catmullRom(float t)
{
    float t2 = t * t, t3 = t2 * t;
    return vec4(-0.5f * t + t2 - 0.5f * t3, 1.0f - 2.5f * t2 + 1.5f * t3, 0.5f * t + 2.0f * t2 - 1.5f * t3,
                -0.5f * t2 + 0.5f * t3);
}

#endif
