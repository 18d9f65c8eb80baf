// Ray against box and triangle, robust at the extremes. Pure functions; C++ tests include this text.
//
// Triangle: signed volumes of the ray's line and each edge (Pluecker test; Shevtsov et al. 2007, "Ray-Triangle
// Intersection Algorithm for Modern CPU Architectures"; the form is Embree's robust one, described by Benthin 2006).
// The volume of a shared edge is the same number with the opposite sign in both triangles, because its two factors are
// a difference and a sum of the same two corners: rounding cannot open a gap between neighbours (watertight), and no
// epsilon is needed. Box: slabs with the far side widened by the rounding of three operations (Ize 2013, "Robust BVH
// Ray Traversal").
#ifndef Q3RT_LIB_INTERSECT_GLSL
#define Q3RT_LIB_INTERSECT_GLSL

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

// Hit in (tMin, tMax). Zero-area triangles are never hit (denominator 0).
TriangleHit intersectTriangle(vec3 origin, vec3 direction, vec3 corner0, vec3 corner1, vec3 corner2, float tMin,
                              float tMax)
{
    TriangleHit result;
    result.hit = false;
    result.frontFace = false;
    result.t = tMax;
    result.barycentric = vec2(0.0);
    vec3 v0 = corner0 - origin;
    vec3 v1 = corner1 - origin;
    vec3 v2 = corner2 - origin;
    vec3 e0 = v2 - v0;
    vec3 e1 = v0 - v1;
    vec3 e2 = v1 - v2;
    float u = dot(cross(e0, v2 + v0), direction); // edge 2-0: weight of corner 1
    float v = dot(cross(e1, v0 + v1), direction); // edge 0-1: weight of corner 2
    float w = dot(cross(e2, v1 + v2), direction); // edge 1-2: weight of corner 0
    float smallest = min(u, min(v, w));
    float largest = max(u, max(v, w));
    if (smallest < 0.0 && largest > 0.0)
        return result;
    // Edges of the untranslated corners: their rounding is relative to the edge, not to the distance of the origin.
    vec3 normal = stableNormal(corner2 - corner0, corner0 - corner1, corner1 - corner2);
    float denominator = dot(normal, direction);
    float t = dot(v0, normal) / denominator;
    if (denominator == 0.0 || !(t > tMin && t < tMax))
        return result;
    float sum = u + v + w;
    result.hit = true;
    result.frontFace = denominator > 0.0;
    result.t = t;
    result.barycentric = sum != 0.0 ? vec2(u, v) / sum : vec2(0.0);
    return result;
}

#endif
