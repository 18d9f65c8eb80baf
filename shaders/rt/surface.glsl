// A hit point of the scene with interpolated attributes and the texture footprint of the ray that found it.
#ifndef Q3RT_RT_SURFACE_GLSL
#define Q3RT_RT_SURFACE_GLSL
#include "lib/offset.glsl"
#include "lib/ray.glsl"
#include "rt/scene.glsl"

struct SurfacePoint {
    RtSurface surface;
    uint entity;
    HitPoint hit;         // world
    vec3 modelPosition;   // model space, for tcGen and tcMod
    vec3 modelNormal;     // model space, unit or 0
    vec3 normal;          // world, unit, shading; the side that the vertices say
    vec3 geometricNormal; // world, unit, on the side that the ray came from
    bool frontFace;       // the ray sees the triangle clockwise
    vec2 st;
    vec2 lightmapSt;
    vec4 color; // vertex colour [0, 1]
    mat2 stPerPixel; // columns: change of st from one pixel to the next in x and in y
    mat2 lightmapStPerPixel;
    mat2x3 positionPerPixel; // model space
};

vec3 rotateToWorld(RtEntity entity, vec3 v)
{
    return vec3(dot(vec3(entity.worldFromModel[0]), v), dot(vec3(entity.worldFromModel[1]), v),
                dot(vec3(entity.worldFromModel[2]), v));
}

// Normals take the cofactor of the linear part (its inverse transpose, times the determinant).
vec3 normalToWorld(RtEntity entity, vec3 n)
{
    vec3 r0 = vec3(entity.worldFromModel[0]), r1 = vec3(entity.worldFromModel[1]), r2 = vec3(entity.worldFromModel[2]);
    vec3 c0 = cross(r1, r2);
    vec3 result = vec3(dot(c0, n), dot(cross(r2, r0), n), dot(cross(r0, r1), n));
    return dot(c0, r0) < 0.0 ? -result : result;
}

vec3 unitOr(vec3 v, vec3 fallback)
{
    float size2 = dot(v, v);
    return size2 > 0.0 ? v * inversesqrt(size2) : fallback;
}

vec3 pointToWorld(RtEntity entity, vec3 p)
{
    vec4 h = vec4(p, 1.0);
    return vec3(dot(entity.worldFromModel[0], h), dot(entity.worldFromModel[1], h), dot(entity.worldFromModel[2], h));
}

vec2 interpolate(vec2 a, vec2 b, vec2 c, vec2 weights) { return a + (b - a) * weights.x + (c - a) * weights.y; }

// From the hit to where a neighbouring ray meets the triangle's plane, in weights of corners 1 and 2. A ray that
// passes the plane (or a triangle without area) has no footprint: the finest texels are taken.
vec2 stepOnPlane(vec3 p0, vec3 p1, vec3 p2, vec3 origin, vec3 direction, vec2 barycentric)
{
    vec2 step = planeBarycentric(p0, p1, p2, origin, direction) - barycentric;
    return any(isnan(step)) || any(isinf(step)) ? vec2(0.0) : step;
}

// `directionX`, `directionY`: unit directions of the rays through the neighbouring pixels.
SurfacePoint makeSurfacePoint(uint instanceIndex, uint triangle, vec2 barycentric, vec3 origin, vec3 direction,
                              vec3 directionX, vec3 directionY)
{
    SceneTriangle found = findTriangle(instanceIndex, triangle);
    RtEntity entity = EntityTable(rtFrame.entities).at[found.entity];
    Vertex v0 = loadVertex(found.vertices, found.vertex.x), v1 = loadVertex(found.vertices, found.vertex.y),
           v2 = loadVertex(found.vertices, found.vertex.z);
    SurfacePoint point;
    point.surface = SurfaceTable(rtFrame.surfaces).at[found.surface];
    point.entity = found.entity;
    HitPoint local = makeHitPoint(v0.position, v1.position, v2.position, barycentric);
    point.modelPosition = local.position;
    point.hit = found.entity == 0u ? local
                                   : transformHitPoint(entity.worldFromModel[0], entity.worldFromModel[1],
                                                       entity.worldFromModel[2], local, rtFrame.inverseError);
    vec3 p0 = pointToWorld(entity, v0.position), p1 = pointToWorld(entity, v1.position),
         p2 = pointToWorld(entity, v2.position);
    // Clockwise triangles face the viewer: (c - a) x (b - a) points to them.
    vec3 facing = cross(p2 - p0, p1 - p0);
    point.frontFace = dot(facing, direction) < 0.0;
    point.geometricNormal = unitOr(point.frontFace ? facing : -facing, -direction);
    vec3 n = v0.normal + (v1.normal - v0.normal) * barycentric.x + (v2.normal - v0.normal) * barycentric.y;
    point.modelNormal = unitOr(n, vec3(0.0));
    point.normal = unitOr(normalToWorld(entity, n), point.geometricNormal);
    point.st = interpolate(v0.st, v1.st, v2.st, barycentric);
    point.lightmapSt = interpolate(v0.lightmapSt, v1.lightmapSt, v2.lightmapSt, barycentric);
    vec4 c0 = unpackUnorm4x8(v0.color), c1 = unpackUnorm4x8(v1.color), c2 = unpackUnorm4x8(v2.color);
    point.color = c0 + (c1 - c0) * barycentric.x + (c2 - c0) * barycentric.y;

    vec2 stepX = stepOnPlane(p0, p1, p2, origin, directionX, barycentric);
    vec2 stepY = stepOnPlane(p0, p1, p2, origin, directionY, barycentric);
    mat2 st = mat2(v1.st - v0.st, v2.st - v0.st);
    mat2 lightmapSt = mat2(v1.lightmapSt - v0.lightmapSt, v2.lightmapSt - v0.lightmapSt);
    mat2x3 edges = mat2x3(v1.position - v0.position, v2.position - v0.position);
    point.stPerPixel = mat2(st * stepX, st * stepY);
    point.lightmapStPerPixel = mat2(lightmapSt * stepX, lightmapSt * stepY);
    point.positionPerPixel = mat2x3(edges * stepX, edges * stepY);
    return point;
}

#endif
