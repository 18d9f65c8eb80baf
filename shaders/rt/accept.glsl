// Questions that the tracer asks while a ray is under way. The same functions serve every back end.
#ifndef Q3RT_RT_ACCEPT_GLSL
#define Q3RT_RT_ACCEPT_GLSL
#include "rt/material.glsl"
#include "rt/work.glsl"
#include "trace/trace.glsl"

// Geometric facts of a candidate triangle, without its attributes.
struct Candidate {
    SceneTriangle triangle;
    RtSurface surface;
    vec3 facing; // world; (c - a) x (b - a): toward the side from which it is seen clockwise
};

Candidate findCandidate(uint instance, uint triangle)
{
    Candidate result;
    result.triangle = findTriangle(instance, triangle);
    result.surface = SurfaceTable(rtFrame.surfaces).at[result.triangle.surface];
    RtEntity entity = EntityTable(rtFrame.entities).at[result.triangle.entity];
    vec3 a = pointToWorld(entity, loadVertexPosition(result.triangle.vertices, result.triangle.vertex.x));
    vec3 b = pointToWorld(entity, loadVertexPosition(result.triangle.vertices, result.triangle.vertex.y));
    vec3 c = pointToWorld(entity, loadVertexPosition(result.triangle.vertices, result.triangle.vertex.z));
    result.facing = cross(c - a, b - a);
    return result;
}

bool showsFrom(RtSurface surface, vec3 facing, vec3 direction)
{
    float side = dot(facing, direction);
    return !((surface.flags & kSurfaceCullBack) != 0u && side >= 0.0) &&
           !((surface.flags & kSurfaceCullFront) != 0u && side <= 0.0);
}

// Nearly all alpha-tested surfaces are one texture over the texture coordinates of their vertices.
uint coverAt(uint instance, uint triangle, vec2 barycentric)
{
    countWork(kWorkAnyHit);
    SceneTriangle found = findTriangle(instance, triangle);
    uint flags = SurfaceTable(rtFrame.surfaces).at[found.surface].flags;
    uint cover = SurfaceTable(rtFrame.surfaces).at[found.surface].cover;
    if ((flags & kSurfaceTested) == 0u)
        return kCoverSolid;
    if (cover == 0u)
        return kCoverUnsure;
    vec2 st = interpolate(loadVertexSt(found.vertices, found.vertex.x), loadVertexSt(found.vertices, found.vertex.y),
                          loadVertexSt(found.vertices, found.vertex.z), barycentric);
    if ((cover & kCoverClamped) == 0u)
        st = wrapCoordinates(st);
    float alpha = textureLod(textures[nonuniformEXT(cover >> kCoverTextureShift)], st, 0.0).a;
    return passesAlphaTest(cover & kCoverTest, alpha) ? kCoverSolid : kCoverHole;
}

// Rays that look (unit directions) respect the sides of a surface; shadow rays, whose direction spans the whole way to
// the light, are stopped from both sides, as by the solid class.
bool acceptHit(uint instance, uint triangle, vec2 barycentric, float t, vec3 direction)
{
    uint cover = coverAt(instance, triangle, barycentric);
    if (cover != kCoverUnsure)
        return cover == kCoverSolid;
    SceneTriangle found = findTriangle(instance, triangle);
    return isCovered(found, SurfaceTable(rtFrame.surfaces).at[found.surface], barycentric);
}

// Most of a square of smoke is the margin of its texture.
bool leavesSomething(Candidate candidate, vec2 barycentric)
{
    if ((candidate.surface.flags & kSurfacePartly) == 0u)
        return true;
    SceneTriangle found = candidate.triangle;
    vec2 st = interpolate(loadVertexSt(found.vertices, found.vertex.x), loadVertexSt(found.vertices, found.vertex.y),
                          loadVertexSt(found.vertices, found.vertex.z), barycentric);
    uvec2 cell = uvec2(clamp(st * float(kShownSide), vec2(0.0), vec2(float(kShownSide - 1u))));
    uint bit = cell.y * kShownSide + cell.x;
    return (SurfaceTable(rtFrame.surfaces).at[found.surface].shown[bit >> 5u] >> (bit & 31u) & 1u) != 0u;
}

// Where a layer stands along the ray in drawing order. Layers in one plane (marks, decals, coats of paint) come at the
// same distance but for rounding: the later drawn one is moved toward the eye by twice the error bound of a distance
// for each step of the drawing order, at grazing angles by more, because there an error across the plane is a longer
// one along the ray.
float layerDistance(uint instance, uint triangle, vec2 barycentric, float t, vec3 origin, vec3 direction)
{
    countWork(kWorkLayer);
    Candidate candidate = findCandidate(instance, triangle);
    float size = length(candidate.facing);
    if (size == 0.0 || !showsFrom(candidate.surface, candidate.facing, direction) ||
        !leavesSomething(candidate, barycentric))
        return -1.0;
    float cosine = abs(dot(candidate.facing, direction)) / size;
    return t - sameDistanceStep(t, length(origin), cosine) * float(candidate.surface.drawOrder);
}

#endif
