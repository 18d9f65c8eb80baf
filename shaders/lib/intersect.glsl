// Ray against the boxes of a tree's node and against a triangle, robust at the extremes. Pure functions; C++ tests
// include this text.
#ifndef Q3RT_LIB_INTERSECT_GLSL
#define Q3RT_LIB_INTERSECT_GLSL
#include "shared/bvh.h"

// Reciprocal of a direction for slab tests. A zero component becomes 2^-80: the slab bounds stay finite (|b - o| * 2^80
// < 2^127 for |b - o| < 2^47 qu), and the ray it stands for bends by less than an ulp over 2^56 qu.
vec3 slabReciprocal(vec3 direction)
{
    const float tiny = 8.271806125530277e-25f; // 2^-80
    return vec3(1.0f / (abs(direction.x) < tiny ? tiny : direction.x),
                1.0f / (abs(direction.y) < tiny ? tiny : direction.y),
                1.0f / (abs(direction.z) < tiny ? tiny : direction.z));
}

// Bound of a slab's distance, relative to the sizes of its two terms: 10 u, see makeSlabRay().
const float kSlabError = 5.9604644775390625e-7f;

// A ray as the box test wants it: a plane at b is entered at b x reciprocal + enter, left at b x reciprocal + leave.
struct SlabRay {
    vec3 reciprocal;
    vec3 enter;
    vec3 leave;
};

// `reciprocal` of slabReciprocal(). `reach`: of the tree, no plane's coordinate is larger. |origin|, reach < 2^46.
//
// No box that the exact ray meets is missed. A plane at b is met at t = (b - o) / d, computed as b r - o r, r = 1/d.
// With u = 2^-24 the roundings are: r 5 u (Vulkan allows a division 2.5 ulp), a product u each, their difference and
// that with E below u each. So |error| <= 8 u (|b r| + |o r|) <= 10 u (reach + |o|) |r| = E with room for the terms of
// second order and for E's own roundings; entering planes are moved E towards the origin, leaving ones E away. In space
// that is 10 u of the farthest coordinate, 0.005 qu on a map of 8,192.
SlabRay makeSlabRay(vec3 origin, vec3 reciprocal, float reach)
{
    vec3 along = -origin * reciprocal;
    vec3 error = (abs(origin) + reach) * abs(reciprocal) * kSlabError;
    SlabRay ray;
    ray.reciprocal = reciprocal;
    ray.enter = along - error;
    ray.leave = along + error;
    return ray;
}

// Children of a node whose boxes the ray may meet in [tMin, tMax], tMin >= 0: a bit each. `first`: the one that it
// enters first. `near`, `far`: the planes where it enters and leaves, of four children.
//
// Comparisons are of integers: the larger of a float and a float >= 0 is that of their bits as integers, and so is
// the smaller one unless one is negative, when the result is negative and the box is behind the ray. (Sorting floats
// by instructions that must also pass over NaN takes three times as many on a CPU; there is no NaN here.)
uint boxesMet(vec4 nearX, vec4 nearY, vec4 nearZ, vec4 farX, vec4 farY, vec4 farZ, SlabRay ray, float tMin, float tMax,
              OUT(uint) first)
{
    ivec4 enterX = floatBitsToInt(nearX * ray.reciprocal.x + ray.enter.x);
    ivec4 enterY = floatBitsToInt(nearY * ray.reciprocal.y + ray.enter.y);
    ivec4 enterZ = floatBitsToInt(nearZ * ray.reciprocal.z + ray.enter.z);
    ivec4 leaveX = floatBitsToInt(farX * ray.reciprocal.x + ray.leave.x);
    ivec4 leaveY = floatBitsToInt(farY * ray.reciprocal.y + ray.leave.y);
    ivec4 leaveZ = floatBitsToInt(farZ * ray.reciprocal.z + ray.leave.z);
    ivec4 enter = max(max(max(enterX, enterY), enterZ), ivec4(floatBitsToInt(tMin)));
    ivec4 leave = min(min(min(leaveX, leaveY), leaveZ), ivec4(floatBitsToInt(tMax)));
    // The child's number stands in the lowest bits of its distance.
    ivec4 order = (enter & ~3) | ivec4(0, 1, 2, 3);
    const int kMissed = 0x7fffffff;
    order.x = enter.x <= leave.x ? order.x : kMissed;
    order.y = enter.y <= leave.y ? order.y : kMissed;
    order.z = enter.z <= leave.z ? order.z : kMissed;
    order.w = enter.w <= leave.w ? order.w : kMissed;
    first = uint(min(min(min(order.x, order.y), order.z), order.w)) & 3u;
    return (enter.x <= leave.x ? 1u : 0u) | (enter.y <= leave.y ? 2u : 0u) | (enter.z <= leave.z ? 4u : 0u) |
           (enter.w <= leave.w ? 8u : 0u);
}

// A ray as the triangle test wants it: axes in a cyclic order that ends with the one along which the ray goes farthest.
struct TriangleRay {
    uvec3 axes;
    vec3 origin; // in this order
    vec3 direction;
    vec3 shear; // x and y that go with a z of 1; z: units of the direction
};

float componentOf(vec3 v, uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }
vec3 componentsOf(vec3 v, uvec3 axes)
{
    return vec3(componentOf(v, axes.x), componentOf(v, axes.y), componentOf(v, axes.z));
}
// Back from the order of a ray's axes.
vec3 fromOrder(vec3 v, uvec3 axes)
{
    return axes.z == 2u ? v : axes.z == 0u ? vec3(v.z, v.x, v.y) : vec3(v.y, v.z, v.x);
}

// `reciprocal` of slabReciprocal().
TriangleRay makeTriangleRay(vec3 origin, vec3 direction, vec3 reciprocal)
{
    vec3 size = abs(direction);
    uint last = size.x >= size.y && size.x >= size.z ? 0u : size.y >= size.z ? 1u : 2u;
    uint next = last == 2u ? 0u : last + 1u;
    TriangleRay ray;
    ray.axes = uvec3(next, next == 2u ? 0u : next + 1u, last);
    ray.origin = componentsOf(origin, ray.axes);
    ray.direction = componentsOf(direction, ray.axes);
    float unit = componentOf(reciprocal, last);
    ray.shear = vec3(ray.direction.x * unit, ray.direction.y * unit, unit);
    return ray;
}

struct TriangleHit {
    bool hit;
    bool frontFace;   // clockwise as the ray sees it: the side that the engine shows
    float t;
    vec2 barycentric; // weights of corner 1 and 2
};

// Twice the area vector from the two shorter edges: of the three products of edge pairs, which are equal in exact
// arithmetic, that one cancels least on slivers.
vec3 stableNormal(vec3 e0, vec3 e1, vec3 e2)
{
    float l0 = dot(e0, e0), l1 = dot(e1, e1), l2 = dot(e2, e2);
    if (l0 >= l1 && l0 >= l2)
        return cross(e1, e2);
    return l1 >= l2 ? cross(e2, e0) : cross(e0, e1);
}

// A corner, relative to the ray's origin, as it is seen along the ray.
vec2 seenAlongRay(vec3 corner, vec3 shear)
{
    PRECISE float x = corner.x - shear.x * corner.z;
    PRECISE float y = corner.y - shear.y * corner.z;
    return vec2(x, y);
}

// Twice the area of the origin and two points; exactly the opposite for the points in the other order.
float edgeFunction(vec2 a, vec2 b)
{
    PRECISE float area = a.x * b.y - a.y * b.x;
    return area;
}

// Hit in (tMin, tMax). Corners in the ray's order of axes. Woop, Benthin and Wald 2013, "Watertight Ray/Triangle
// Intersection": each corner is projected by itself, so that neighbours see a shared corner at the same place, and an
// edge function is the difference of two rounded products. Rounding keeps order, so that difference is never of the
// wrong sign, at worst 0, which counts as inside: no ray slips through an edge or a corner, at any distance from the
// origin, and no epsilon is needed. Nothing may be contracted into fused operations there. Triangles that the ray sees
// as a line are never hit.
TriangleHit intersectTriangle(TriangleRay ray, vec3 corner0, vec3 corner1, vec3 corner2, float tMin, float tMax)
{
    TriangleHit result;
    result.hit = false;
    result.frontFace = false;
    result.t = tMax;
    result.barycentric = vec2(0.0f);
    vec3 v0 = corner0 - ray.origin;
    vec3 v1 = corner1 - ray.origin;
    vec3 v2 = corner2 - ray.origin;
    vec2 p0 = seenAlongRay(v0, ray.shear), p1 = seenAlongRay(v1, ray.shear), p2 = seenAlongRay(v2, ray.shear);
    float w0 = edgeFunction(p1, p2), w1 = edgeFunction(p2, p0), w2 = edgeFunction(p0, p1);
    if ((w0 < 0.0f || w1 < 0.0f || w2 < 0.0f) && (w0 > 0.0f || w1 > 0.0f || w2 > 0.0f))
        return result;
    float sum = w0 + w1 + w2;
    if (sum == 0.0f)
        return result;
    // The distance of the plane, from the corner that is nearest, whose rounding is least, and from edges of the
    // untranslated corners, whose rounding is relative to the edge and not to the distance of the origin. Where a
    // sliver or an edge-on triangle has no plane to speak of, that of the corners.
    vec3 normal = stableNormal(corner2 - corner0, corner0 - corner1, corner1 - corner2);
    vec3 nearest = v0;
    if (dot(v1, v1) < dot(nearest, nearest))
        nearest = v1;
    if (dot(v2, v2) < dot(nearest, nearest))
        nearest = v2;
    float t = dot(nearest, normal) / dot(normal, ray.direction);
    float z0 = v0.z * ray.shear.z, z1 = v1.z * ray.shear.z, z2 = v2.z * ray.shear.z;
    if (!(t >= min(z0, min(z1, z2)) && t <= max(z0, max(z1, z2))))
        t = (w0 * z0 + w1 * z1 + w2 * z2) / sum;
    if (!(t > tMin && t < tMax))
        return result;
    result.hit = true;
    result.frontFace = (sum > 0.0f) == (ray.shear.z > 0.0f);
    result.t = t;
    result.barycentric = vec2(w1, w2) / sum;
    return result;
}

#endif
