// Our own two-level tree as the shaders read it. Scalar layout. Bytes: 128 a node of up to four children, 48 a
// triangle, 80 an instance.
#ifndef Q3RT_SHARED_BVH_H
#define Q3RT_SHARED_BVH_H
#include "types.h"
#ifdef __cplusplus
#define BVH_TABLE uint64_t
#else
#define BVH_TABLE uvec2
#endif
SHARED_BEGIN

SHARED_CONST kBvhWidth = 4u;
// BvhNode::child: a node's index; or a leaf: this bit, how many items, the first of them.
SHARED_CONST kBvhLeafBit = 0x80000000u;
SHARED_CONST kBvhCountShift = 27u;
SHARED_CONST kBvhMostLeafItems = 15u;
SHARED_CONST kBvhItemMask = 0x07ffffffu;
// Deepest path of any tree that a builder returns; the traversal stack of one level is that long.
SHARED_CONST kBvhMaxDepth = 64u;

// Rays look for one of two groups of triangles (renderer_rt sorts surfaces into them); a subtree without any is
// passed by. Bits of an item; in BvhNode::groups kBvhWidth bits say which children have solids, the next kBvhWidth
// which have others.
SHARED_CONST kBvhSolidGroup = 1u;
SHARED_CONST kBvhOtherGroup = 2u;

// A GPU's cache line. Bounds are whole numbers of binary32, not smaller ones on a grid: unpacking those takes more
// instructions than all the tests of a visit, and instructions are what tracing costs (docs/tracing.md).
struct BvhNode {
    vec4 bounds[6]; // low x, y, z, high x, y, z; a child a component
    uint child[4];  // an absent one is in no group
    uint groups;
    float reach; // of the root: no coordinate of the tree is farther from 0
    uint reserved0;
    uint reserved1;
};
// From a child's lower bound to the upper one on the same axis, in BvhNode::bounds.
SHARED_CONST kBvhToHigh = 3u;
SHARED_CONST kBvhNodePlanes = 8u; // vec4s a node

SHARED_CONST kBvhTriangleOpaque = 1u;   // a hit counts without asking anybody
SHARED_CONST kBvhTriangleCullBack = 2u; // rays that look don't meet its back
SHARED_CONST kBvhPartShift = 8u;        // from this bit on: its part of the tree
SHARED_CONST kBvhMostParts = 8u;

// What a search returns for "how far does it go on" when it is over.
SHARED_FLOAT kBvhFound = -1.0f;

// From a corner to the next one.
SHARED_CONST kBvhCornerWords = 4u;

// Corners are stored in leaf order and not shared: no index fetch. A test reads the nine coordinates, a hit the rest.
struct BvhTriangle {
    vec3 corner0;
    uint number; // in its part
    vec3 corner1;
    uint flags; // kBvhTriangle*, part
    vec3 corner2;
    uint reserved;
};

// Of an instance's mask, above the bits of any ray's: its model space is the world's, no ray needs turning.
SHARED_CONST kBvhInPlace = 0x100u;

// A tree placed in the scene. Tables are device addresses (test code: pointers), so that trees built at load and trees
// built for this frame can live in different buffers.
struct BvhInstance {
    vec4 modelFromWorld[3]; // rows of the linear part; w: where the model's origin stands in the world
    BVH_TABLE nodes;        // BvhNode[], [0] the root
    BVH_TABLE triangles;    // BvhTriangle[] in leaf order
    uint customIndex;       // what a hit of part 0 reports; part n: n more
    uint mask;              // of all its parts: a ray enters when mask & rayMask != 0; kBvhInPlace
    uint partMasks[2];      // a byte a part: its triangles are met when it has a bit of the ray's mask
};

SHARED_END
#endif
