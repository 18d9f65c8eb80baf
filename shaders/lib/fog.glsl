// Fog volumes: coordinates of a point in its fog and the density there (spec of world, 6.3).
#ifndef Q3RT_LIB_FOG_GLSL
#define Q3RT_LIB_FOG_GLSL

// s: 1/512 at the eye's plane, 1/8 further at the depth where fog is opaque. t: how much of the way is inside.
// `viewDepthQu` along the view's forward axis (not radial). `pointDepthQu` and `eyeDepthQu`: below the fog's surface
// plane, distance - dot(normal, p); pass 0 and 1 where the fog has no surface.
vec2 fogCoordinates(float viewDepthQu, float depthForOpaqueQu, float pointDepthQu, float eyeDepthQu)
{
    const float kOutside = 1.0f / 32.0f, kInside = 31.0f / 32.0f, kSpan = 30.0f / 32.0f;
    float s = viewDepthQu / (8.0f * max(depthForOpaqueQu, 1.0f)) + 1.0f / 512.0f;
    if (eyeDepthQu >= 0.0f)
        return vec2(s, pointDepthQu < 0.0f ? kOutside : kInside);
    // The eye is outside: the share of the way that is below the surface.
    float t = pointDepthQu < 1.0f ? kOutside : kOutside + kSpan * pointDepthQu / (pointDepthQu - eyeDepthQu);
    return vec2(s, t);
}

// Weight of the fog colour, [0, 1], in the original's 256 steps.
float fogDensity(vec2 coordinates)
{
    float s = coordinates.x - 1.0f / 512.0f;
    float t = coordinates.y;
    if (s < 0.0f || t < 1.0f / 32.0f)
        return 0.0f;
    if (t < 31.0f / 32.0f)
        s *= (t - 1.0f / 32.0f) / (30.0f / 32.0f);
    return sqrt(floor(min(1.0f, s * 8.0f) * 255.0f) / 255.0f);
}
#endif
