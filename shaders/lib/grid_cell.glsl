// One cell of the light grid as surfaces, or as models, take it: a row of 16 bytes, as a point reads eight of them.
#ifndef Q3RT_LIB_GRID_CELL_GLSL
#define Q3RT_LIB_GRID_CELL_GLSL
#include "lib/octahedral.glsl"

struct GridCellLight {
    vec3 ambient;   // luxel units; binary16: up to 65504, to a 2048th
    vec3 directed;  // the same
    vec3 direction; // unit, toward the light; to a thousandth (the map stores steps of 1.4 degrees)
    float sunSeen;  // share of the suns that shine here, in 64ths
    bool valid;     // not inside a wall
};

const float kGridDirectionSteps = 2047.0f; // of a component of the octahedral map, either way
const float kGridSunSteps = 64.0f;
const float kGridLightMax = 65504.0f;

uvec4 packGridCell(GridCellLight cell)
{
    vec3 ambient = min(cell.ambient, vec3(kGridLightMax));
    bool directs = dot(cell.direction, cell.direction) > 0.0f;
    vec3 directed = directs ? min(cell.directed, vec3(kGridLightMax)) : vec3(0.0f);
    vec2 e = octahedralOf(directs ? cell.direction : vec3(0.0f, 0.0f, 1.0f));
    uint x = uint(floor((e.x + 1.0f) * kGridDirectionSteps + 0.5f));
    uint y = uint(floor((e.y + 1.0f) * kGridDirectionSteps + 0.5f));
    uint sun = uint(floor(clamp(cell.sunSeen, 0.0f, 1.0f) * kGridSunSteps + 0.5f));
    return uvec4(packHalf2x16(vec2(ambient.x, ambient.y)), packHalf2x16(vec2(ambient.z, directed.x)),
                 packHalf2x16(vec2(directed.y, directed.z)), x | y << 12u | sun << 24u | (cell.valid ? 1u << 31u : 0u));
}

GridCellLight unpackGridCell(uvec4 row)
{
    vec2 first = unpackHalf2x16(row.x), second = unpackHalf2x16(row.y), third = unpackHalf2x16(row.z);
    vec2 e = vec2(float(row.w & 0xfffu), float(row.w >> 12u & 0xfffu)) / kGridDirectionSteps - vec2(1.0f);
    GridCellLight cell;
    cell.ambient = vec3(first.x, first.y, second.x);
    cell.directed = vec3(second.y, third.x, third.y);
    cell.direction = fromOctahedral(e);
    cell.sunSeen = float(row.w >> 24u & 0x7fu) / kGridSunSteps;
    cell.valid = row.w >> 31u != 0u;
    return cell;
}

#endif
