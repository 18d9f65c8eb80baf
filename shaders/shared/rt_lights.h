// Lights and the table of who sees which: one text for C++ and GLSL, scalar layout.
#ifndef Q3RT_SHARED_RT_LIGHTS_H
#define Q3RT_SHARED_RT_LIGHTS_H
#include "types.h"
SHARED_BEGIN

struct RtTriangleLight {
    vec3 corner;
    float areaQu2;
    vec3 edge1;
    uint flags; // kLight*
    vec3 edge2;
    float error; // bound of a sampled point's distance from the triangle's plane, qu
    vec3 normal; // unit, lit side
    uint animation; // 1 + index of its colour in the frame's table; 0: it never changes
    vec3 radiance; // luxel units / pi
    float faintest; // irradiance of the largest channel at or below which it gives nothing far off, luxel units
};

// From farther than so many times its size, the root of its area, the light of a triangle's middle stands for all.
SHARED_FLOAT kFarTriangleSizes = 4.0f;

SHARED_CONST kLightTwoSided = 0x1u;
SHARED_CONST kLightUpward = 0x2u; // shines only where it is seen above the horizon

SHARED_CONST kLightSphere = 0u;
SHARED_CONST kLightSun = 1u;

// Lights that are not triangles.
struct RtLight {
    vec3 position; // sphere: centre; sun: unit direction to it
    uint kind;
    vec3 power; // sphere: intensity, luxel units qu^2; sun: irradiance, luxel units
    float size; // sphere: radius, qu; sun: 1 - cos(half angle)
    vec3 axis;  // spot: unit direction of its cone
    float spot; // radius of its cone at distance 1; 0: no cone
    float faintest; // sphere: irradiance of the largest channel at or below which it gives nothing, luxel units
};

// Points of a cluster by their shading normal. Class 0: all; 1 + 2 axis: exactly along that axis, + 1 against it.
SHARED_CONST kNormalClassCount = 7u;

// Row of the light table, numbered cluster x kNormalClassCount + class; behind the last cluster stands one row for all
// points outside.
struct RtLightRow {
    uint first;  // in lightEntries
    uint count;  // lights that the map's visibility does not rule out
    uint facing; // the first so many also shine toward this row; one of them is chosen at random
    uint seesSky; // 0: no sky is potentially visible; suns cannot reach it
    float plane;  // classes 1 and up: the row serves points at least so far along their normal, qu
    uint reserved0;
    uint reserved1;
    uint reserved2;
};

// A light of a row, and a column of the row's alias table over the facing ones.
struct RtLightEntry {
    uint light; // < triangleLightCount: a triangle light, else a point light
    uint odds;  // packUnorm2x16(): chanceOf(), seenOf()
    uint other; // column
    float weight; // 1 / probability of this light
};

SHARED_END
#endif
