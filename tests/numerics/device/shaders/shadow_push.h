// What the shadow-ray test gives to its shaders: one text for C++ and GLSL, scalar layout.
#ifndef Q3RT_TESTS_SHADOW_PUSH_H
#define Q3RT_TESTS_SHADOW_PUSH_H
#include "shared/rt_scene.h"
SHARED_BEGIN

struct ShadowInput {
    vec3 corner[3];
    vec2 barycentric;
    vec3 normal; // unit, world
    vec3 light;
};

struct ShadowPush {
    SHARED_ADDRESS rays;    // ShadowInput[]
    SHARED_ADDRESS results; // uint[], 1: the light is seen
    SHARED_ADDRESS treeNodes;
    SHARED_ADDRESS treeInstances;
    vec4 worldFromModel[3];
    uint count;
    uint instanced;
    float inverseError;
    uint reserved;
};

SHARED_END
#endif
