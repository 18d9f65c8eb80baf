// What bench_rays gives to its shader: one text for C++ and GLSL, scalar layout.
#ifndef Q3RT_TESTS_RAYS_PUSH_H
#define Q3RT_TESTS_RAYS_PUSH_H
#include "shared/rt_scene.h"
SHARED_BEGIN

struct BenchRay {
    vec3 origin;
    vec3 direction;
};

struct RaysPush {
    SHARED_ADDRESS rays;    // BenchRay[], row by row
    SHARED_ADDRESS results; // float[]: distance of the hit, 0: none
    SHARED_ADDRESS treeNodes;
    SHARED_ADDRESS treeInstances;
    uint width;
    uint height;
    float tMax;
    uint reserved;
};

SHARED_END
#endif
