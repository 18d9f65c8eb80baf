// A point of a triangle, uniform by the solid angle that it fills seen from the origin (Arvo 1995, "Stratified Sampling
// of Spherical Triangles"), with the solid angle of van Oosterom and Strackee 1983, "The Solid Angle of a Plane
// Triangle".
//
// Arvo works with the triangle's angles and its excess over pi, which cancels for small triangles. Here both steps are
// solved by tangents of half angles, and every small quantity is a product: the triple product of the corners is
// twice the area times the distance of the plane, sines are distances from lines. So the relative error of the solid
// angle is that of the distance of the plane, and the point is exact to a few roundings of the triangle's own size,
// from slivers that fill 1e-12 sr to 2 pi: no threshold below which another method is needed.
#ifndef Q3RT_LIB_SPHERICAL_TRIANGLE_GLSL
#define Q3RT_LIB_SPHERICAL_TRIANGLE_GLSL
#include "lib/trigonometry.glsl"

struct SphericalTriangle {
    vec3 corner; // from the shaded point
    vec3 edge1;
    vec3 edge2;
    vec3 lengths;    // of the ways to the three corners
    float triple;    // |corner . (edge1 x edge2)|
    float halfAngle; // half of the solid angle, in [0, pi]
};

// `heightQu`: distance of the shaded point from the triangle's plane.
SphericalTriangle makeSphericalTriangle(vec3 corner, vec3 edge1, vec3 edge2, float heightQu, float areaQu2)
{
    SphericalTriangle t;
    t.corner = corner;
    t.edge1 = edge1;
    t.edge2 = edge2;
    t.triple = 2.0f * areaQu2 * heightQu;
    vec3 b = corner + edge1;
    vec3 c = corner + edge2;
    t.lengths = vec3(length(corner), length(b), length(c));
    float denominator = t.lengths.x * t.lengths.y * t.lengths.z + dot(corner, b) * t.lengths.z +
                        dot(b, c) * t.lengths.x + dot(c, corner) * t.lengths.y;
    t.halfAngle = angleOf(t.triple, denominator);
    return t;
}

// A coordinate of a sampled point along an edge. Rounding may leave [0, 1], or divide 0 by 0 where the whole edge is
// one direction.
float alongEdge(float numerator, float denominator)
{
    float at = numerator / denominator;
    return denominator > 0.0f && at < 1.0f ? max(at, 0.0f) : 1.0f;
}

// Way from the shaded point to the sampled one.
vec3 sampleSphericalTriangle(SphericalTriangle t, float u, float v)
{
    // The great circle through b and a point c' of the arc ac that cuts off u of the solid angle. With the angle x
    // between a and c', T = tan(u x half the solid angle), d the unit vector across a toward c:
    //     T = tan(x/2) a.(b x d) / (1 + a.b + tan(x/2) b.d)
    vec3 b = t.corner + t.edge1;
    float alongA = dot(t.edge2, t.corner) / t.lengths.x;
    vec3 across = t.edge2 - t.corner * (alongA / t.lengths.x);
    float size = length(across);
    vec2 part = cosineSine(u * t.halfAngle);
    float halfSine = part.y * size * (t.lengths.x * t.lengths.y + dot(t.corner, b));
    float halfCosine = part.x * t.triple - part.y * t.lengths.x * dot(t.edge1, across);
    float scale = halfSine * halfSine + halfCosine * halfCosine;
    float sine = 2.0f * halfSine * halfCosine / scale;
    float cosine = (halfCosine * halfCosine - halfSine * halfSine) / scale;
    float onEdge = halfCosine > 0.0f ? alongEdge(t.lengths.x * sine, size * cosine - alongA * sine) : 1.0f;
    // A point of the arc from b to c', uniform in the cosine of its angle from b.
    vec3 edge = t.edge2 * onEdge - t.edge1;
    float end2 = dot(b + edge, b + edge);
    float alongB = dot(edge, b) / t.lengths.y;
    across = edge - b * (alongB / t.lengths.y);
    float size2 = dot(across, across);
    float endCosine = (t.lengths.y + alongB) * inversesqrt(end2);
    float endSine2 = size2 / end2;
    float fromOne = v * (endCosine > 0.0f ? endSine2 / (1.0f + endCosine) : 1.0f - endCosine);
    sine = sqrt(fromOne * (2.0f - fromOne));
    cosine = 1.0f - fromOne;
    return b + edge * alongEdge(t.lengths.y * sine, sqrt(size2) * cosine - alongB * sine);
}

#endif
