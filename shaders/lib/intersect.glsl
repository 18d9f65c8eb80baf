// Ray against box and triangle, robust at the extremes. Pure functions; C++ tests include this text.
//
// Triangle: corners are seen along the ray (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection"): each is
// projected by itself, so that neighbours see a shared corner at the same place, and an edge function is the difference
// of two rounded products. Rounding keeps order, so that difference is never of the wrong sign, at worst 0, which
// counts as inside: no ray slips through an edge or a corner, and no epsilon is needed. Nothing may be contracted into
// fused operations there. Box: slabs with the far side widened by the rounding of three operations (Ize 2013, "Robust
// BVH Ray Traversal").
#ifndef Q3RT_LIB_INTERSECT_GLSL
#define Q3RT_LIB_INTERSECT_GLSL
#include "shared/types.h"

// 1 + 2 gamma(3), gamma(n) = n u / (1 - n u), u = 2^-24: Ize 2013, eq. 12.
const float kSlabFarScale = 1.0000004;

// Reciprocal of a direction for slab tests. A zero component becomes 2^-80: the slab bounds stay finite (|b - o| * 2^80
// < 2^127 for |b - o| < 2^47 qu), and the ray it stands for bends by less than an ulp over 2^56 qu.
vec3 slabReciprocal(vec3 direction)
{
    const float tiny = 8.271806125530277e-25; // 2^-80
    return vec3(1.0 / (abs(direction.x) < tiny ? tiny : direction.x),
                1.0 / (abs(direction.y) < tiny ? tiny : direction.y),
                1.0 / (abs(direction.z) < tiny ? tiny : direction.z));
}

// Entry distance of the ray into the box, or a value > tMax if it misses [tMin, tMax].
float intersectBox(vec3 origin, vec3 reciprocal, vec3 mins, vec3 maxs, float tMin, float tMax)
{
    vec3 a = (mins - origin) * reciprocal;
    vec3 b = (maxs - origin) * reciprocal;
    vec3 low = min(a, b);
    vec3 high = max(a, b);
    float near = max(max(low.x, low.y), max(low.z, tMin));
    float far = min(min(high.x, high.y), min(high.z, tMax)) * kSlabFarScale;
    return near <= far ? near : 3.4e38;
}

// The ray's own axes: z along the largest component of its direction, x and y sheared until the ray is z alone.
struct RayFrame {
    uint axis;  // 0..2: which component is z
    vec3 shear; // x and y that go with a z of 1; z: units of the direction
};

// `reciprocal` of slabReciprocal().
RayFrame makeRayFrame(vec3 direction, vec3 reciprocal)
{
    vec3 size = abs(direction);
    if (size.x >= size.y && size.x >= size.z)
        return RayFrame(0u, vec3(direction.y * reciprocal.x, direction.z * reciprocal.x, reciprocal.x));
    if (size.y >= size.z)
        return RayFrame(1u, vec3(direction.z * reciprocal.y, direction.x * reciprocal.y, reciprocal.y));
    return RayFrame(2u, vec3(direction.x * reciprocal.z, direction.y * reciprocal.z, reciprocal.z));
}

// A point, relative to the ray's origin, in the ray's axes; z not yet in units of the direction.
vec3 toRayFrame(RayFrame frame, vec3 p)
{
    vec3 turned = frame.axis == 0u ? vec3(p.y, p.z, p.x) : frame.axis == 1u ? vec3(p.z, p.x, p.y) : p;
    PRECISE float x = turned.x - frame.shear.x * turned.z;
    PRECISE float y = turned.y - frame.shear.y * turned.z;
    return vec3(x, y, turned.z);
}

// Twice the area of the origin and two points; exactly the opposite for the points in the other order.
float edgeFunction(vec3 a, vec3 b)
{
    PRECISE float area = a.x * b.y - a.y * b.x;
    return area;
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

// Hit in (tMin, tMax). Triangles that the ray sees as a line are never hit.
TriangleHit intersectTriangle(vec3 origin, RayFrame frame, vec3 direction, vec3 corner0, vec3 corner1, vec3 corner2,
                              float tMin, float tMax)
{
    TriangleHit result;
    result.hit = false;
    result.frontFace = false;
    result.t = tMax;
    result.barycentric = vec2(0.0);
    vec3 v0 = corner0 - origin;
    vec3 v1 = corner1 - origin;
    vec3 v2 = corner2 - origin;
    vec3 p0 = toRayFrame(frame, v0), p1 = toRayFrame(frame, v1), p2 = toRayFrame(frame, v2);
    float w0 = edgeFunction(p1, p2), w1 = edgeFunction(p2, p0), w2 = edgeFunction(p0, p1);
    if (min(w0, min(w1, w2)) < 0.0 && max(w0, max(w1, w2)) > 0.0)
        return result;
    float sum = w0 + w1 + w2;
    if (sum == 0.0)
        return result;
    // The distance of the plane, from edges of the untranslated corners: their rounding is relative to the edge, not to
    // the distance of the origin. Where a sliver or an edge-on triangle has no plane to speak of, that of the corners.
    vec3 normal = stableNormal(corner2 - corner0, corner0 - corner1, corner1 - corner2);
    float t = dot(v0, normal) / dot(normal, direction);
    float z0 = p0.z * frame.shear.z, z1 = p1.z * frame.shear.z, z2 = p2.z * frame.shear.z;
    if (!(t >= min(z0, min(z1, z2)) && t <= max(z0, max(z1, z2))))
        t = (w0 * z0 + w1 * z1 + w2 * z2) / sum;
    if (!(t > tMin && t < tMax))
        return result;
    result.hit = true;
    result.frontFace = (sum > 0.0) == (frame.shear.z > 0.0);
    result.t = t;
    result.barycentric = vec2(w1, w2) / sum;
    return result;
}

#endif
