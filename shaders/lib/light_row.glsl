// The classes of a light row's points (shared/rt_lights.h).
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

#endif
