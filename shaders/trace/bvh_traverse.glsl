// Two-level traversal of our own tree: a stack, the child that the ray enters first goes first. Loops, no recursion;
// bounded by the depth that builders guarantee. Pure but for what the includer defines:
//   bool kBvhDescends                                        nodes are visited in a loop of their own, as far as a leaf
//   struct BvhQuery                                          what the search carries along
//   vec4 loadBvhPlane(BVH_TABLE nodes, uint index, uint plane)        a node's bounds[plane]
//   uint loadBvhChild(BVH_TABLE nodes, uint index, uint slot)         its child[slot]
//   uint loadBvhGroups(BVH_TABLE nodes, uint index)
//   float loadBvhReach(BVH_TABLE nodes)                               of the root
//   float loadBvhCoordinate(BVH_TABLE triangles, uint index, uint corner, uint axis)
//   BvhInstance loadBvhInstance(INOUT(BvhQuery) query, uint item)     the instance at a leaf item of the scene tree
//   float onBvhTriangle(INOUT(BvhQuery) query, uint item, BVH_TABLE triangles, uint index, TriangleHit test,
//                       float tMax)
//     a triangle that the ray meets, of the instance at that item; returns how far the search goes on: tMax, or less,
//     or kBvhFound, which ends it
#ifndef Q3RT_TRACE_BVH_TRAVERSE_GLSL
#define Q3RT_TRACE_BVH_TRAVERSE_GLSL
#include "lib/intersect.glsl"
#include "shared/bvh.h"

// One level's ray.
struct BvhRay {
    uvec3 enters; // BvhNode::bounds of the planes where it enters boxes, an axis each
    SlabRay slabs;
    TriangleRay triangle;
};

BvhRay makeBvhRay(vec3 origin, vec3 direction, BVH_TABLE nodes)
{
    vec3 reciprocal = slabReciprocal(direction);
    BvhRay ray;
    ray.enters = uvec3(reciprocal.x < 0.0f ? kBvhToHigh : 0u, reciprocal.y < 0.0f ? kBvhToHigh + 1u : 1u,
                       reciprocal.z < 0.0f ? kBvhToHigh + 2u : 2u);
    ray.slabs = makeSlabRay(origin, reciprocal, loadBvhReach(nodes));
    ray.triangle = makeTriangleRay(origin, direction, reciprocal);
    return ray;
}

// The ray in the model space of an instance; the direction keeps its scale, so that t means the same in both spaces.
// Its origin is taken relative to the instance's place first: what is left to turn is small wherever that is.
BvhRay toModelSpace(BvhInstance instance, vec3 origin, vec3 direction)
{
    vec4 m0 = instance.modelFromWorld[0], m1 = instance.modelFromWorld[1], m2 = instance.modelFromWorld[2];
    vec3 r0 = vec3(m0), r1 = vec3(m1), r2 = vec3(m2);
    vec3 away = origin - vec3(m0.w, m1.w, m2.w);
    return makeBvhRay(vec3(dot(r0, away), dot(r1, away), dot(r2, away)),
                      vec3(dot(r0, direction), dot(r1, direction), dot(r2, direction)), instance.nodes);
}

// Children of a node that the ray may meet and that hold something of `wanted`; as boxesMet().
uint visitBvhNode(BvhRay ray, BVH_TABLE nodes, uint index, uint wanted, float tMin, float tMax, OUT(uint) first)
{
    // By address, not by choosing between planes that were read. It leaves by the other plane of an axis.
    uint met = boxesMet(loadBvhPlane(nodes, index, ray.enters.x), loadBvhPlane(nodes, index, ray.enters.y),
                        loadBvhPlane(nodes, index, ray.enters.z),
                        loadBvhPlane(nodes, index, kBvhToHigh - ray.enters.x),
                        loadBvhPlane(nodes, index, kBvhToHigh + 2u - ray.enters.y),
                        loadBvhPlane(nodes, index, kBvhToHigh + 4u - ray.enters.z), ray.slabs, tMin, tMax, first);
    uint held = loadBvhGroups(nodes, index) & wanted;
    return met & (held | (held >> kBvhWidth));
}

vec3 loadBvhCorner(BVH_TABLE triangles, uint index, uint corner, uvec3 axes)
{
    return vec3(loadBvhCoordinate(triangles, index, corner, axes.x),
                loadBvhCoordinate(triangles, index, corner, axes.y),
                loadBvhCoordinate(triangles, index, corner, axes.z));
}

// Tests the triangles of a leaf; returns how far the search goes on.
float visitBvhLeaf(TriangleRay ray, uint item, BVH_TABLE triangles, uint leaf, float tMin, float tMax,
                   INOUT(BvhQuery) query)
{
    uint first = leaf & kBvhItemMask;
    uint end = first + ((leaf & ~kBvhLeafBit) >> kBvhCountShift);
    for (uint i = first; i < end; ++i) {
        TriangleHit test = intersectTriangle(ray, loadBvhCorner(triangles, i, 0u, ray.axes),
                                             loadBvhCorner(triangles, i, 1u, ray.axes),
                                             loadBvhCorner(triangles, i, 2u, ray.axes), tMin, tMax);
        if (test.hit)
            tMax = onBvhTriangle(query, item, triangles, i, test, tMax);
    }
    return tMax;
}

// A ray on the stack: origin and direction.
const uint kBvhParkedWords = 6u;

// Visits the triangles that the ray meets in (tMin, tMax), nearest boxes first. 0 <= tMin. `groups`: of triangles, that
// are looked for (kBvhSolidGroup, kBvhOtherGroup).
void traverseBvh(BVH_TABLE sceneNodes, vec3 origin, vec3 direction, float tMin, float tMax, uint mask, uint groups,
                 INOUT(BvhQuery) query)
{
    // A word holds a node and those of its children that are still to be visited, a bit each: one push a visit at most.
    // Words below `modelBase` belong to the scene. While a model is searched that is not in place the world's ray
    // waits on top of them: rays that can be held in fewer registers are traced by more at a time.
    const uint slots = (1u << kBvhWidth) - 1u;
    uint wanted = ((groups & kBvhSolidGroup) != 0u ? slots : 0u) |
                  ((groups & kBvhOtherGroup) != 0u ? slots << kBvhWidth : 0u);
    uint stack[2u * kBvhMaxDepth + kBvhParkedWords];
    uint top = 0u;
    const uint kNoModel = 0xffffffffu;
    uint modelBase = kNoModel;
    BvhRay ray = makeBvhRay(origin, direction, sceneNodes);
    bool turned = false; // into a model's space
    BVH_TABLE nodes = sceneNodes;
    BVH_TABLE triangles = sceneNodes;
    uint item = 0u;
    uint rest = 0u;
    uint child = 0u;
    for (;;) {
        uint slot = kBvhWidth;
        bool inner = (child & kBvhLeafBit) == 0u;
        while (inner) {
            uint first;
            uint met = visitBvhNode(ray, nodes, child, wanted, tMin, tMax, first);
            if (met == 0u)
                break;
            if ((rest & slots) != 0u)
                stack[top++] = rest;
            rest = (child << kBvhWidth) | met;
            if ((met & (1u << first)) == 0u)
                break;
            slot = first;
            if (!kBvhDescends)
                break;
            rest ^= 1u << slot;
            child = loadBvhChild(nodes, rest >> kBvhWidth, slot);
            slot = kBvhWidth;
            inner = (child & kBvhLeafBit) == 0u;
        }
        if (inner) {
            // Its children are next.
        } else if (modelBase != kNoModel) {
            tMax = visitBvhLeaf(ray.triangle, item, triangles, child, tMin, tMax, query);
            if (tMax < 0.0)
                return;
        } else {
            // A leaf of the scene is one instance.
            item = child & kBvhItemMask;
            BvhInstance instance = loadBvhInstance(query, item);
            if ((instance.mask & mask) != 0u) {
                if ((rest & slots) != 0u)
                    stack[top++] = rest;
                turned = (instance.mask & kBvhInPlace) == 0u;
                if (turned) {
                    vec3 worldOrigin = fromOrder(ray.triangle.origin, ray.triangle.axes);
                    vec3 worldDirection = fromOrder(ray.triangle.direction, ray.triangle.axes);
                    stack[top++] = floatBitsToUint(worldOrigin.x);
                    stack[top++] = floatBitsToUint(worldOrigin.y);
                    stack[top++] = floatBitsToUint(worldOrigin.z);
                    stack[top++] = floatBitsToUint(worldDirection.x);
                    stack[top++] = floatBitsToUint(worldDirection.y);
                    stack[top++] = floatBitsToUint(worldDirection.z);
                    ray = toModelSpace(instance, worldOrigin, worldDirection);
                }
                modelBase = top;
                nodes = instance.nodes;
                triangles = instance.triangles;
                rest = 0u;
                child = 0u;
                continue;
            }
        }
        if (slot == kBvhWidth) {
            if ((rest & slots) == 0u) {
                bool leaves = top == modelBase;
                if (leaves && turned)
                    top -= kBvhParkedWords;
                if (top == 0u)
                    return;
                if (leaves) {
                    modelBase = kNoModel;
                    nodes = sceneNodes;
                    if (turned)
                        ray = makeBvhRay(vec3(uintBitsToFloat(stack[top]), uintBitsToFloat(stack[top + 1u]),
                                              uintBitsToFloat(stack[top + 2u])),
                                         vec3(uintBitsToFloat(stack[top + 3u]), uintBitsToFloat(stack[top + 4u]),
                                              uintBitsToFloat(stack[top + 5u])), sceneNodes);
                }
                rest = stack[--top];
            }
            uint lowest = rest & (~rest + 1u);
            slot = lowest > 2u ? (lowest >> 2u) + 1u : lowest >> 1u; // its number: 1, 2, 4, 8 to 0, 1, 2, 3
        }
        rest ^= 1u << slot;
        child = loadBvhChild(nodes, rest >> kBvhWidth, slot);
    }
}

#endif
