// The classes of a light row's points, and what its entries hold (shared/rt_lights.h).
#ifndef Q3RT_LIB_LIGHT_ROW_GLSL
#define Q3RT_LIB_LIGHT_ROW_GLSL
#include "shared/rt_lights.h"

// Class of a unit normal. No tolerance: a light behind the plane of such a normal gives exactly nothing.
uint normalClass(vec3 n)
{
    if (n.y == 0.0f && n.z == 0.0f)
        return n.x > 0.0f ? 1u : 2u;
    if (n.x == 0.0f && n.z == 0.0f)
        return n.y > 0.0f ? 3u : 4u;
    if (n.x == 0.0f && n.y == 0.0f)
        return n.z > 0.0f ? 5u : 6u;
    return 0u;
}

// How far along its normal a point of a class (1 and up) lies.
float alongClass(uint which, vec3 p)
{
    float along = which < 3u ? p.x : which < 5u ? p.y : p.z;
    return (which & 1u) != 0u ? along : -along;
}

// That a drawn column gives its own light; else it is that of its column `other`.
float chanceOf(RtLightEntry entry) { return unpackUnorm2x16(entry.odds).x; }

// About how much of a light arrives at the row's points, (0, 1]: guides the choice, decides nothing.
float seenOf(RtLightEntry entry) { return unpackUnorm2x16(entry.odds).y; }

#endif
