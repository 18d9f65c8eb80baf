// From world points to places in a picture.
#ifndef Q3RT_LIB_PROJECTION_GLSL
#define Q3RT_LIB_PROJECTION_GLSL

// The inverse of cameraDirection(): place in the picture, (0, 0) top left to (1, 1) bottom right, and depth along the
// view's axis. The place means nothing where depth <= 0.
vec3 projectPoint(vec3 eye, vec3 forward, vec3 left, vec3 up, vec3 forwardUnit, vec3 point)
{
    vec3 v = point - eye;
    float depth = dot(v, forwardUnit) / dot(forward, forwardUnit);
    vec3 aside = v / depth - forward;
    return vec3(0.5f - 0.5f * dot(aside, left) / dot(left, left), 0.5f - 0.5f * dot(aside, up) / dot(up, up), depth);
}

#endif
