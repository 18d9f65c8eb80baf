// Two-level traversal of our own tree: stack, near child first. Loops, no recursion; bounded by the depth that builders
// guarantee. Pure but for what the includer defines:
//   struct BvhQuery                             what the search carries along
//   BvhNode loadBvhNode(BVH_TABLE table, uint index)        BvhTriangle loadBvhTriangle(BVH_TABLE table, uint index)
//   BvhInstance loadBvhInstance(INOUT(BvhQuery) query, uint item)   the instance at a leaf item of the scene tree
//   bool onBvhTriangle(INOUT(BvhQuery) query, BvhInstance instance, BvhTriangle triangle, TriangleHit test)
//                                               a triangle that the ray meets; true: it counts, nothing behind it does
#ifndef Q3RT_TRACE_BVH_TRAVERSE_GLSL
#define Q3RT_TRACE_BVH_TRAVERSE_GLSL
#include "lib/intersect.glsl"
#include "shared/bvh.h"

// One level's ray with what its slab tests need.
struct BvhRay {
    vec3 origin;
    vec3 direction;
    vec3 reciprocal;
};

BvhRay makeBvhRay(vec3 origin, vec3 direction)
{
    return BvhRay(origin, direction, slabReciprocal(direction));
}

// The ray in the model space of an instance; the direction keeps its scale, so that t means the same in both spaces.
// Its origin is taken relative to the instance's place first: what is left to turn is small wherever that is.
BvhRay toModelSpace(BvhInstance instance, vec3 origin, vec3 direction)
{
    vec4 m0 = instance.modelFromWorld[0], m1 = instance.modelFromWorld[1], m2 = instance.modelFromWorld[2];
    vec3 r0 = vec3(m0), r1 = vec3(m1), r2 = vec3(m2);
    vec3 away = origin - vec3(m0.w, m1.w, m2.w);
    return makeBvhRay(vec3(dot(r0, away), dot(r1, away), dot(r2, away)),
                      vec3(dot(r0, direction), dot(r1, direction), dot(r2, direction)));
}

// Tests the triangles of a leaf, shortening tMax at each one that counts; true when one did.
bool visitLeaf(BvhRay ray, RayFrame frame, BvhInstance instance, uint first, uint count, float tMin, INOUT(float) tMax,
               INOUT(BvhQuery) query)
{
    bool counted = false;
    for (uint i = 0u; i < count; ++i) {
        BvhTriangle triangle = loadBvhTriangle(instance.triangles, first + i);
        TriangleHit test = intersectTriangle(ray.origin, frame, ray.direction, triangle.corner0,
                                             triangle.corner1, triangle.corner2, tMin, tMax);
        if (test.hit && onBvhTriangle(query, instance, triangle, test)) {
            tMax = test.t;
            counted = true;
        }
    }
    return counted;
}

// Visits the triangles that the ray meets in (tMin, tMax), nearest boxes first; returns the t of the last one that
// counted, or tMax. With anyHit the first one ends the search.
float traverseBvh(BVH_TABLE sceneNodes, vec3 origin, vec3 direction, float tMin, float tMax, uint mask, bool anyHit,
                  INOUT(BvhQuery) query)
{
    // Entries: a node, or a leaf (kBvhLeafBit) with its count beside it. Those below `modelBase` belong to the scene.
    uint stackChild[2u * kBvhMaxDepth];
    uint stackCount[2u * kBvhMaxDepth];
    uint top = 0u;
    const uint kNoModel = 0xffffffffu;
    uint modelBase = kNoModel;
    BvhInstance instance;
    BvhRay world = makeBvhRay(origin, direction);
    BvhRay ray = world;
    RayFrame frame; // of a model's ray: triangles are met there only
    BVH_TABLE nodes = sceneNodes;
    uint child = 0u;
    uint count = 0u;
    for (;;) {
        if ((child & kBvhLeafBit) == 0u) {
            BvhNode node = loadBvhNode(nodes, child);
            float left = intersectBox(ray.origin, ray.reciprocal, node.leftMins, node.leftMaxs, tMin, tMax);
            float right = intersectBox(ray.origin, ray.reciprocal, node.rightMins, node.rightMaxs, tMin, tMax);
            bool leftHit = left <= tMax, rightHit = right <= tMax;
            if (leftHit || rightHit) {
                bool leftFirst = leftHit && (!rightHit || left <= right);
                child = leftFirst ? node.left : node.right;
                count = leftFirst ? node.leftCount : node.rightCount;
                if (leftHit && rightHit) {
                    stackChild[top] = leftFirst ? node.right : node.left;
                    stackCount[top] = leftFirst ? node.rightCount : node.leftCount;
                    ++top;
                }
                continue;
            }
        } else if (modelBase != kNoModel) {
            if (visitLeaf(ray, frame, instance, child & ~kBvhLeafBit, count, tMin, tMax, query) && anyHit)
                return tMax;
        } else if (count > 0u) {
            // One instance of a scene leaf at a time; the rest of the leaf waits on the stack.
            uint first = child & ~kBvhLeafBit;
            if (count > 1u) {
                stackChild[top] = kBvhLeafBit | (first + 1u);
                stackCount[top] = count - 1u;
                ++top;
            }
            instance = loadBvhInstance(query, first);
            if ((instance.mask & mask) != 0u) {
                modelBase = top;
                ray = toModelSpace(instance, origin, direction);
                frame = makeRayFrame(ray.direction, ray.reciprocal);
                nodes = instance.nodes;
                child = 0u;
                count = 0u;
                continue;
            }
        }
        if (top == modelBase) {
            modelBase = kNoModel;
            ray = world;
            nodes = sceneNodes;
        }
        if (top == 0u)
            return tMax;
        --top;
        child = stackChild[top];
        count = stackCount[top];
    }
    return tMax;
}

#endif
