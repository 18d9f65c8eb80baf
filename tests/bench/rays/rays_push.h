// What bench_rays gives to its shader: one text for C++ and GLSL, scalar layout.
#ifndef Q3RT_TESTS_RAYS_PUSH_H
#define Q3RT_TESTS_RAYS_PUSH_H
#include "shared/bvh.h"
#include "shared/rt_scene.h"
SHARED_BEGIN

struct BenchRay {
    vec3 origin;
    vec3 direction;
};

// A child's box of a tree, for traversal without a stack.
struct RopedBox {
    vec3 low;
    uint skip; // the box that comes after all that this one holds
    vec3 high;
    uint leaf; // as BvhNode::child; 0: what it holds follows
};

struct RaysPush {
    SHARED_ADDRESS rays;    // BenchRay[], row by row
    SHARED_ADDRESS results; // float[]: distance of the hit, 0: none
    SHARED_ADDRESS treeNodes; // of the scene; RopedBox[]
    SHARED_ADDRESS treeInstances;
    uint width;
    uint height;
    float tMax;
    uint boxCount; // RopedBox[]
    float reach;   // no coordinate is farther from 0
    uint reserved;
};

SHARED_END
#endif
