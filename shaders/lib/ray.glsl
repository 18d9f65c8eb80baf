// Camera rays and the footprint that chooses texture detail.
#ifndef Q3RT_LIB_RAY_GLSL
#define Q3RT_LIB_RAY_GLSL

// Unit direction through a point of the picture, (0, 0) top left to (1, 1) bottom right. `left` and `up` are scaled by
// the tangents of the half fields of view.
vec3 cameraDirection(vec3 forward, vec3 left, vec3 up, vec2 point)
{
    return normalize(forward + left * (1.0f - 2.0f * point.x) + up * (1.0f - 2.0f * point.y));
}

// Weights of corners 1 and 2 where a ray meets the plane of a triangle (not limited to the triangle). The tracer's own
// weights are used for the hit itself; this gives those of neighbouring rays, hence derivatives.
vec2 planeBarycentric(vec3 corner0, vec3 corner1, vec3 corner2, vec3 origin, vec3 direction)
{
    vec3 edge1 = corner1 - corner0;
    vec3 edge2 = corner2 - corner0;
    vec3 p = cross(direction, edge2);
    float determinant = dot(edge1, p);
    vec3 s = origin - corner0;
    vec3 q = cross(s, edge1);
    return vec2(dot(s, p), dot(direction, q)) / determinant;
}

#endif
