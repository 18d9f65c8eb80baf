// Two-level traversal of our own tree: stack, near child first. Loops, no recursion; bounded by the depth that builders
// guarantee. Pure but for what the includer defines:
//   BvhNode loadBvhNode(uint index)            BvhTriangle loadBvhTriangle(uint index)
//   BvhInstance loadBvhInstance(uint index)    uint loadBvhInstanceIndex(uint item)  (leaf item -> instance)
//   bool acceptHit(uint customIndex, uint geometry, uint primitive, vec2 barycentric, float t)
//                                              called for non-opaque geometry only; false: the ray goes on
#ifndef Q3RT_TRACE_BVH_TRAVERSE_GLSL
#define Q3RT_TRACE_BVH_TRAVERSE_GLSL
#include "lib/intersect.glsl"
#include "shared/bvh.h"

struct BvhHit {
    float t;          // tMax of the ray if nothing was hit
    uint instance;    // 0xffffffff: no hit
    uint customIndex;
    uint geometry;
    uint primitive;
    vec2 barycentric; // weights of corner 1 and 2
    bool frontFace;
};
const uint kBvhNoInstance = 0xffffffffu;

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
BvhRay toModelSpace(BvhInstance instance, vec3 origin, vec3 direction)
{
    vec4 o = vec4(origin, 1.0);
    vec4 d = vec4(direction, 0.0);
    return makeBvhRay(vec3(dot(instance.modelFromWorld[0], o), dot(instance.modelFromWorld[1], o),
                           dot(instance.modelFromWorld[2], o)),
                      vec3(dot(instance.modelFromWorld[0], d), dot(instance.modelFromWorld[1], d),
                           dot(instance.modelFromWorld[2], d)));
}

// Tests the triangles of a leaf; returns true when the search may stop (any hit is enough).
bool intersectLeaf(BvhRay ray, BvhInstance instance, uint instanceIndex, uint first, uint count, float tMin,
                   bool anyHit, INOUT(BvhHit) hit)
{
    for (uint i = 0u; i < count; ++i) {
        BvhTriangle triangle = loadBvhTriangle(instance.firstTriangle + first + i);
        TriangleHit test = intersectTriangle(ray.origin, ray.direction, triangle.corner0, triangle.corner1,
                                             triangle.corner2, tMin, hit.t);
        if (!test.hit)
            continue;
        uint geometry = triangle.geometry & ~kBvhOpaqueBit;
        bool opaque = (triangle.geometry & kBvhOpaqueBit) != 0u;
        if (!opaque && !acceptHit(instance.customIndex, geometry, triangle.primitive, test.barycentric, test.t))
            continue;
        hit = BvhHit(test.t, instanceIndex, instance.customIndex, geometry, triangle.primitive, test.barycentric,
                     test.frontFace);
        if (anyHit)
            return true;
    }
    return false;
}

// Closest accepted hit in (tMin, tMax), or any of them. `sceneRoot` is the root of the tree over instances.
BvhHit traverseBvh(uint sceneRoot, vec3 origin, vec3 direction, float tMin, float tMax, uint mask, bool anyHit)
{
    BvhHit hit;
    hit.t = tMax;
    hit.instance = kBvhNoInstance;
    hit.customIndex = 0u;
    hit.geometry = 0u;
    hit.primitive = 0u;
    hit.barycentric = vec2(0.0);
    hit.frontFace = false;

    // Entries: a node, or a leaf (kBvhLeafBit) with its count beside it. Below `modelBase` they belong to the scene.
    uint stackChild[2u * kBvhMaxDepth];
    uint stackCount[2u * kBvhMaxDepth];
    uint top = 0u;
    const uint kNoModel = 0xffffffffu;
    uint modelBase = kNoModel;
    uint currentIndex = 0u;
    BvhInstance current;
    BvhRay world = makeBvhRay(origin, direction);
    BvhRay ray = world;
    uint child = sceneRoot;
    uint count = 0u;
    for (;;) {
        if ((child & kBvhLeafBit) == 0u) {
            BvhNode node = loadBvhNode(child);
            float left = intersectBox(ray.origin, ray.reciprocal, node.leftMins, node.leftMaxs, tMin, hit.t);
            float right = intersectBox(ray.origin, ray.reciprocal, node.rightMins, node.rightMaxs, tMin, hit.t);
            bool leftHit = left <= hit.t, rightHit = right <= hit.t;
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
            if (intersectLeaf(ray, current, currentIndex, child & ~kBvhLeafBit, count, tMin, anyHit, hit))
                return hit;
        } else if (count > 0u) {
            // One instance of a scene leaf at a time; the rest of the leaf waits on the stack.
            uint first = child & ~kBvhLeafBit;
            if (count > 1u) {
                stackChild[top] = kBvhLeafBit | (first + 1u);
                stackCount[top] = count - 1u;
                ++top;
            }
            uint index = loadBvhInstanceIndex(first);
            BvhInstance instance = loadBvhInstance(index);
            if ((instance.mask & mask) != 0u) {
                current = instance;
                currentIndex = index;
                modelBase = top;
                ray = toModelSpace(current, origin, direction);
                child = current.root;
                count = 0u;
                continue;
            }
        }
        if (top == modelBase) {
            modelBase = kNoModel;
            ray = world;
        }
        if (top == 0u)
            return hit;
        --top;
        child = stackChild[top];
        count = stackCount[top];
    }
    return hit;
}

#endif
