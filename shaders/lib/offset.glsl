// Origins of rays that leave a surface: moved along its normal by a computed bound of the point's own error, so that
// the surface is never hit again and nothing nearer than the error is skipped. (Offsets by a fixed number of ulps or a
// fixed length are either too short far from the origin or leak light behind thin geometry.) Theory: Pharr, Jakob,
// Humphreys 2016, "Physically Based Rendering" 3rd ed., section 3.9.5; Ize 2013 for the count.
#ifndef Q3RT_LIB_OFFSET_GLSL
#define Q3RT_LIB_OFFSET_GLSL
#include "shared/constants.h"

struct HitPoint {
    vec3 position;
    vec3 error; // per component, >= 0: true point = position +- error
};

// Point of a triangle from its corners and the weights of corners 1 and 2; the count of roundings stands in
// constants.h.
HitPoint makeHitPoint(vec3 corner0, vec3 corner1, vec3 corner2, vec2 barycentric)
{
    vec3 edge1 = corner1 - corner0;
    vec3 edge2 = corner2 - corner0;
    HitPoint hit;
    hit.position = corner0 + (edge1 * barycentric.x + edge2 * barycentric.y);
    vec3 extent3 = max(abs(edge1), abs(edge2));
    float extent = max(extent3.x, max(extent3.y, extent3.z));
    hit.error =
        (abs(corner0) + abs(edge1) * barycentric.x + abs(edge2) * barycentric.y + vec3(extent)) * kHitPointError;
    return hit;
}

// Rows of an affine transform applied to a point with error.
HitPoint transformHitPoint(vec4 row0, vec4 row1, vec4 row2, HitPoint point)
{
    vec4 p = vec4(point.position, 1.0f);
    vec4 size = abs(p);
    HitPoint result;
    result.position = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
    vec3 rounding = vec3(dot(abs(row0), size), dot(abs(row1), size), dot(abs(row2), size)) * kTransformError;
    vec3 carried = vec3(dot(abs(vec3(row0)), point.error), dot(abs(vec3(row1)), point.error),
                        dot(abs(vec3(row2)), point.error));
    result.error = carried * (1.0f + kTransformError) + rounding;
    // The ray itself is transformed back by the intersector: its origin carries the size of the world point again.
    result.error += abs(result.position) * kHitPointError;
    return result;
}

// Distance along the unit normal that clears the error box: |n| . error.
float clearance(vec3 normal, vec3 error) { return dot(abs(normal), error); }

// `normal` is the geometric normal on the side that the ray leaves to. The sum is rounded away from the surface: one
// unit roundoff of its size covers the rounding of the addition.
vec3 offsetOrigin(vec3 position, vec3 error, vec3 normal)
{
    float distance = clearance(normal, error);
    vec3 moved = position + normal * distance;
    return moved + sign(normal) * (abs(moved) * (2.0f * kUnitRoundoff));
}

// How far apart along a unit direction two hits of one point may come out, at distance t from an origin of this size,
// where the surface meets the ray under this cosine.
float sameDistanceStep(float t, float originSize, float cosine)
{
    return (t + originSize) * kSameDistanceError / max(cosine, kGrazingCosine);
}

#endif
