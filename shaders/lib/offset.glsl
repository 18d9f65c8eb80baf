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

// Point of a triangle from its corners and the weights of corners 1 and 2; the counts of roundings stand in
// constants.h.
HitPoint makeHitPoint(vec3 corner0, vec3 corner1, vec3 corner2, vec2 barycentric)
{
    vec3 edge1 = corner1 - corner0;
    vec3 edge2 = corner2 - corner0;
    HitPoint hit;
    hit.position = corner0 + (edge1 * barycentric.x + edge2 * barycentric.y);
    vec3 extent3 = max(abs(edge1), abs(edge2));
    float extent = max(extent3.x, max(extent3.y, extent3.z));
    hit.error = abs(hit.position) * kUnitRoundoff +
                (abs(edge1) * barycentric.x + abs(edge2) * barycentric.y) * kEdgeSumError +
                vec3(extent * kOwnTriangleError);
    return hit;
}

// Rows of an affine transform of orthogonal axes applied to a point with error. An intersector transforms the ray back:
// our own about the instance's place in the world, so that the error is of the point's distance from there; a driver's
// by a plain matrix, with `inverseError` of the place and of the point itself.
HitPoint transformHitPoint(vec4 row0, vec4 row1, vec4 row2, HitPoint point, float inverseError)
{
    vec3 r0 = vec3(row0), r1 = vec3(row1), r2 = vec3(row2), place = vec3(row0.w, row1.w, row2.w);
    vec3 a0 = abs(r0), a1 = abs(r1), a2 = abs(r2), size = abs(point.position);
    vec3 turnedSize = vec3(dot(a0, size), dot(a1, size), dot(a2, size));
    HitPoint result;
    result.position = vec3(dot(r0, point.position), dot(r1, point.position), dot(r2, point.position)) + place;
    // What the way back makes of an error in the world: the inverse's rows are the axes over their squared lengths.
    vec3 away = turnedSize * kInverseError + (abs(result.position) + abs(place)) * inverseError;
    vec3 back = (a0 * away.x + a1 * away.y + a2 * away.z) / (a0 * a0 + a1 * a1 + a2 * a2);
    vec3 inModel = point.error + size * kTransformError + back;
    result.error = vec3(dot(a0, inModel), dot(a1, inModel), dot(a2, inModel)) + abs(result.position) * kUnitRoundoff;
    return result;
}

// Distance along the unit normal that clears the error box: |n| . error.
float clearance(vec3 normal, vec3 error) { return dot(abs(normal), error); }

// `normal` is the geometric normal on the side that the ray leaves to. The sum is rounded by no more than one unit
// roundoff of its size: that much farther.
vec3 offsetOrigin(vec3 position, vec3 error, vec3 normal)
{
    return position + normal * clearance(normal, error + abs(position) * kUnitRoundoff);
}

// How far apart along a unit direction two hits of one point may come out, at distance t from an origin of this size,
// where the surface meets the ray under this cosine.
float sameDistanceStep(float t, float originSize, float cosine)
{
    return (t + originSize) * kSameDistanceError / max(cosine, kGrazingCosine);
}

#endif
