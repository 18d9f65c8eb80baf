// What one stage leaves for another, and what rays read at random, moves in rows of 16 bytes: a GPU moves a row by one
// instruction, where a structure goes member by member. (Storing the primary stage's pixels so takes an H200 a third of
// the time.) The structures of shaders/shared have their rows in order.
#ifndef Q3RT_RT_ROWS_GLSL
#define Q3RT_RT_ROWS_GLSL
#include "lib/grid_cell.glsl"
#include "shared/rt_look.h"
#include "shared/rt_motion.h"
#include "shared/rt_shadow.h"
#include "shared/vertex.h"

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer RowTable { uvec4 at[]; };

uvec4 makeRow(vec3 v, uint last) { return uvec4(floatBitsToUint(v), last); }
vec3 vectorOf(uvec4 row) { return uintBitsToFloat(uvec3(row)); }

const uint kPixelRows = 6u;

RtPixel loadPixel(SHARED_ADDRESS pixels, uint index)
{
    uint first = index * kPixelRows;
    uvec4 r0 = RowTable(pixels).at[first], r1 = RowTable(pixels).at[first + 1u], r2 = RowTable(pixels).at[first + 2u],
          r3 = RowTable(pixels).at[first + 3u], r4 = RowTable(pixels).at[first + 4u],
          r5 = RowTable(pixels).at[first + 5u];
    return RtPixel(vectorOf(r0), r0.w, vectorOf(r1), r1.w, vectorOf(r2), r2.w, vectorOf(r3), r3.w, vectorOf(r4), r4.w,
                   vectorOf(r5), r5.w);
}

void storePixel(SHARED_ADDRESS pixels, uint index, RtPixel pixel)
{
    uint first = index * kPixelRows;
    RowTable(pixels).at[first] = makeRow(pixel.position, pixel.lit);
    RowTable(pixels).at[first + 1u] = makeRow(pixel.error, pixel.keyPixel);
    RowTable(pixels).at[first + 2u] = makeRow(pixel.normal, pixel.keyFrame);
    RowTable(pixels).at[first + 3u] = makeRow(pixel.geometricNormal, pixel.instance);
    RowTable(pixels).at[first + 4u] = makeRow(pixel.albedo, pixel.triangle);
    RowTable(pixels).at[first + 5u] = makeRow(pixel.emission, pixel.barycentric);
}

RtGuide loadGuide(SHARED_ADDRESS guides, uint index)
{
    uvec4 row = RowTable(guides).at[index];
    return RtGuide(vectorOf(row), row.w);
}

void storeGuide(SHARED_ADDRESS guides, uint index, RtGuide guide)
{
    RowTable(guides).at[index] = makeRow(guide.position, guide.normal);
}

RtPast loadPast(SHARED_ADDRESS pasts, uint index)
{
    uvec4 row = RowTable(pasts).at[index];
    return RtPast(vectorOf(row), row.w);
}

void storePast(SHARED_ADDRESS pasts, uint index, RtPast past)
{
    RowTable(pasts).at[index] = makeRow(past.position, past.normal);
}

const uint kLookRows = 2u;

RtLook loadLook(SHARED_ADDRESS looks, uint index)
{
    uvec4 r0 = RowTable(looks).at[index * kLookRows], r1 = RowTable(looks).at[index * kLookRows + 1u];
    return RtLook(uintBitsToFloat(r0.x), r0.y, r0.z, r0.w, uintBitsToFloat(uvec2(r1)), uvec2(0u));
}

void storeLookState(SHARED_ADDRESS looks, uint index, uint state) { RowTable(looks).at[index * kLookRows].w = state; }

void storeLook(SHARED_ADDRESS looks, uint index, RtLook seen)
{
    RowTable(looks).at[index * kLookRows] = uvec4(floatBitsToUint(seen.t), seen.instance, seen.triangle, seen.state);
    RowTable(looks).at[index * kLookRows + 1u] = uvec4(floatBitsToUint(seen.barycentric), 0u, 0u);
}

const uint kShadowRayRows = 2u;

RtShadowRay loadShadowRay(SHARED_ADDRESS rays, uint index)
{
    uvec4 r0 = RowTable(rays).at[index * kShadowRayRows], r1 = RowTable(rays).at[index * kShadowRayRows + 1u];
    return RtShadowRay(vectorOf(r0), r0.w, vectorOf(r1), r1.w);
}

void storeShadowRay(SHARED_ADDRESS rays, uint index, RtShadowRay ray)
{
    RowTable(rays).at[index * kShadowRayRows] = makeRow(ray.origin, ray.reserved);
    RowTable(rays).at[index * kShadowRayRows + 1u] = makeRow(ray.direction, ray.fromSky);
}

const uint kVertexRows = 3u;

Vertex loadVertex(SHARED_ADDRESS vertices, uint index)
{
    uint first = index * kVertexRows;
    uvec4 r0 = RowTable(vertices).at[first], r1 = RowTable(vertices).at[first + 1u],
          r2 = RowTable(vertices).at[first + 2u];
    return Vertex(vectorOf(r0), uintBitsToFloat(uvec3(r0.w, r1.x, r1.y)),
                  uintBitsToFloat(uvec2(r1.z, r1.w)), uintBitsToFloat(uvec2(r2)), r2.z, 0u);
}

vec3 loadVertexPosition(SHARED_ADDRESS vertices, uint index)
{
    return vectorOf(RowTable(vertices).at[index * kVertexRows]);
}

vec2 loadVertexSt(SHARED_ADDRESS vertices, uint index)
{
    uvec4 row = RowTable(vertices).at[index * kVertexRows + 1u];
    return uintBitsToFloat(uvec2(row.z, row.w));
}

const uint kTriangleLightRows = 5u;

RtTriangleLight loadTriangleLight(SHARED_ADDRESS lights, uint index)
{
    uint first = index * kTriangleLightRows;
    uvec4 r0 = RowTable(lights).at[first], r1 = RowTable(lights).at[first + 1u], r2 = RowTable(lights).at[first + 2u],
          r3 = RowTable(lights).at[first + 3u], r4 = RowTable(lights).at[first + 4u];
    return RtTriangleLight(vectorOf(r0), uintBitsToFloat(r0.w), vectorOf(r1), r1.w, vectorOf(r2),
                           uintBitsToFloat(r2.w), vectorOf(r3), r3.w, vectorOf(r4), uintBitsToFloat(r4.w));
}

const uint kLightRowRows = 2u;

RtLightRow loadLightRow(SHARED_ADDRESS rows, uint index)
{
    uvec4 r0 = RowTable(rows).at[index * kLightRowRows], r1 = RowTable(rows).at[index * kLightRowRows + 1u];
    return RtLightRow(r0.x, r0.y, r0.z, r0.w, uintBitsToFloat(r1.x), 0u, 0u, 0u);
}

RtLightEntry loadLightEntry(SHARED_ADDRESS entries, uint index)
{
    uvec4 row = RowTable(entries).at[index];
    return RtLightEntry(row.x, row.y, row.z, uintBitsToFloat(row.w));
}

const uint kNodeRows = 2u;

RtNode loadNode(SHARED_ADDRESS nodes, uint index)
{
    uvec4 r0 = RowTable(nodes).at[index * kNodeRows], r1 = RowTable(nodes).at[index * kNodeRows + 1u];
    return RtNode(RtPlane(vectorOf(r0), uintBitsToFloat(r0.w)), int(r1.x), int(r1.y), uvec2(0u));
}

// A cell of the light grid as surfaces (0) or models (1) take it.
GridCellLight loadGridCell(SHARED_ADDRESS grid, uint index, uint taker)
{
    return unpackGridCell(RowTable(grid).at[index * 2u + taker]);
}

#endif
