// Our own two-level tree as the shaders read it. Scalar layout. Bytes: 64 a node, 48 a triangle, 80 an instance.
#ifndef Q3RT_SHARED_BVH_H
#define Q3RT_SHARED_BVH_H
#include "types.h"
#ifdef __cplusplus
#define BVH_TABLE uint64_t
#else
#define BVH_TABLE uvec2
#endif
SHARED_BEGIN

// Set in BvhNode::left/right: the child is a leaf, the low bits its first item.
SHARED_CONST kBvhLeafBit = 0x80000000u;
// Deepest path of any tree that a builder returns; the traversal stack of one level is that long.
SHARED_CONST kBvhMaxDepth = 64u;

// Both children's boxes stand in one node, so that one visit decides both (Aila and Laine 2009, "Understanding the
// Efficiency of Ray Traversal on GPUs"). An absent child is a leaf of 0 items.
struct BvhNode {
    vec3 leftMins;
    uint left; // node index, or kBvhLeafBit | first item
    vec3 leftMaxs;
    uint leftCount; // items of a leaf, 0 for an inner child
    vec3 rightMins;
    uint right;
    vec3 rightMaxs;
    uint rightCount;
};

// Vertices are stored in leaf order and not shared: one cache line and a half a triangle, no index fetch.
struct BvhTriangle {
    vec3 corner0;
    uint number; // triangle number in its structure
    vec3 corner1;
    uint opaque; // 1: a hit counts without asking anybody
    vec3 corner2;
    uint reserved;
};

// A tree placed in the scene. Tables are device addresses (test code: pointers), so that trees built at load and trees
// built for this frame can live in different buffers.
struct BvhInstance {
    vec4 modelFromWorld[3]; // rows of the linear part; w: where the model's origin stands in the world
    BVH_TABLE nodes;        // BvhNode[], [0] the root
    BVH_TABLE triangles;    // BvhTriangle[] in leaf order
    uint customIndex;       // what a hit reports
    uint mask;              // met by a ray when mask & rayMask != 0
    uint cullBack;          // 1: rays that look don't meet its back faces
    uint reserved;
};

SHARED_END
#endif
