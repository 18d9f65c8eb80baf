// Back end `compute`: our own two-level tree in a compute shader. Needs nothing beyond Vulkan 1.2.
#ifndef Q3RT_TRACE_COMPUTE_GLSL
#define Q3RT_TRACE_COMPUTE_GLSL
#include "shared/bvh.h"
#include "shared/rt_scene.h"
#include "trace/trace.glsl"
#include "lib/intersect.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer BvhNodeTable { BvhNode at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer BvhPlaneTable { vec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer BvhTriangleTable { BvhTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer BvhCoordinateTable { float at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer BvhInstanceTable { BvhInstance at[]; };

// What a GPU gains by it, 7 to 14 %, a software device loses (docs/tracing.md).
layout(constant_id = 0) const bool kBvhDescends = true;

// Are there surfaces whose holes take their stages to tell?
layout(constant_id = 1) const bool kBvhStagedCover = true;

const uint kBvhTriangleWords = 3u * kBvhCornerWords;

vec4 loadBvhPlane(uvec2 nodes, uint index, uint plane)
{
    return BvhPlaneTable(nodes).at[index * kBvhNodePlanes + plane];
}
uint loadBvhChild(uvec2 nodes, uint index, uint slot) { return BvhNodeTable(nodes).at[index].child[slot]; }
uint loadBvhGroups(uvec2 nodes, uint index) { return BvhNodeTable(nodes).at[index].groups; }
float loadBvhReach(uvec2 nodes) { return BvhNodeTable(nodes).at[0].reach; }
float loadBvhCoordinate(uvec2 triangles, uint index, uint corner, uint axis)
{
    return BvhCoordinateTable(triangles).at[index * kBvhTriangleWords + corner * kBvhCornerWords + axis];
}

struct BvhQuery {
    bool looks; // a literal at every call: the code and data of the other kind fold away
    bool first; // the first solid, not any
    uint solidMask;
    uint layerMask;
    vec3 origin;
    vec3 direction;
    Sight sight;
    bool unsure;     // what was found may be a hole
    LayerKey passed; // the last of those that was one
};

// Neighbouring numbers of a positive one.
float nextAbove(float x) { return uintBitsToFloat(floatBitsToUint(x) + 1u); }
float nextBelow(float x) { return uintBitsToFloat(floatBitsToUint(x) - 1u); }

// Instances are stored in the leaf order of the scene tree.
BvhInstance loadBvhInstance(inout BvhQuery query, uint item)
{
    return BvhInstanceTable(rtFrame.treeInstances).at[item];
}

float onBvhTriangle(inout BvhQuery query, uint item, uvec2 triangles, uint index, TriangleHit test, float tMax)
{
    uint flags = BvhTriangleTable(triangles).at[index].flags;
    uint part = flags >> kBvhPartShift;
    uint masks = BvhInstanceTable(rtFrame.treeInstances).at[item].partMasks[part >> 2u] >> (8u * (part & 3u));
    if ((masks & (query.solidMask | query.layerMask)) == 0u)
        return tMax;
    uint number = BvhTriangleTable(triangles).at[index].number;
    uint instance = BvhInstanceTable(rtFrame.treeInstances).at[item].customIndex + part;
    if (query.looks && (masks & query.layerMask) != 0u) {
        float distance = layerDistance(instance, number, test.barycentric, test.t, query.origin, query.direction);
        if (distance > 0.0)
            insertLayer(query.sight.layers, Layer(LayerKey(distance, instance, number), test.t, test.barycentric));
        return tMax;
    }
    if (query.looks && (flags & kBvhTriangleCullBack) != 0u && !test.frontFace)
        return tMax;
    Hit held = query.sight.solid;
    if (held.t > 0.0 && test.t > held.t)
        return tMax;
    uint cover = (flags & kBvhTriangleOpaque) != 0u ? kCoverSolid : coverAt(instance, number, test.barycentric);
    LayerKey key = LayerKey(test.t, instance, number);
    bool unsure = kBvhStagedCover && cover == kCoverUnsure;
    if (cover == kCoverHole || (unsure && !isBefore(query.passed, key)))
        return tMax;
    // At one distance a solid wins, then the lower number: all of them are asked, one after the other.
    LayerKey heldKey = LayerKey(held.t, held.instance, held.triangle);
    if (held.t == test.t && !(query.unsure && (!unsure || isBefore(key, heldKey))))
        return tMax;
    query.sight.solid = Hit(test.t, instance, number, test.barycentric);
    query.unsure = unsure;
    if (!query.first && !unsure)
        return kBvhFound;
    // Others at the distance of what may be a hole are wanted still; layers a little behind any solid.
    float end = unsure ? nextAbove(test.t) : test.t;
    return query.looks && query.layerMask != 0u ? min(tMax, max(end, layerReach(test.t, query.origin))) : end;
}

#include "trace/bvh_traverse.glsl"

uint groupsOf(uint mask)
{
    return ((mask & kMasksOfSolids) != 0u ? kBvhSolidGroup : 0u) |
           ((mask & ~kMasksOfSolids) != 0u ? kBvhOtherGroup : 0u);
}

// What takes a material's stages to be told from a hole is asked between searches, not in them, and only in scenes that
// have such surfaces: a search that carries little along is traced by many more rays at a time (docs/tracing.md). A ray
// that went through such a hole goes on searching from there.
void searchTree(inout BvhQuery query, float tMin, float tMax, uint mask)
{
    for (;;) {
        traverseBvh(rtFrame.treeNodes, query.origin, query.direction, tMin, tMax, mask, groupsOf(mask), query);
        Hit found = query.sight.solid;
        if (!kBvhStagedCover || !query.unsure)
            return;
        if (acceptHit(found.instance, found.triangle, found.barycentric, found.t, query.direction))
            return;
        query.passed = LayerKey(found.t, found.instance, found.triangle);
        query.unsure = false;
        query.sight.solid = noHit();
        tMin = nextBelow(found.t);
    }
}

BvhQuery beginQuery(bool looks, bool first, vec3 origin, vec3 direction, uint solidMask, uint layerMask,
                    LayerKey after)
{
    return BvhQuery(looks, first, solidMask, layerMask, origin, direction, Sight(noHit(), emptyBatch(after)), false,
                    LayerKey(0.0, 0u, 0u));
}

Sight traceSight(vec3 origin, vec3 direction, float tMin, float tMax, uint solidMask, uint layerMask, LayerKey after)
{
    BvhQuery query = beginQuery(true, true, origin, direction, solidMask, layerMask, after);
    searchTree(query, tMin, layerMask != 0u ? layerReach(tMax, origin) : tMax, solidMask | layerMask);
    return query.sight;
}

Hit traceSolid(vec3 origin, vec3 direction, float tMax, uint mask, bool first)
{
    BvhQuery query = beginQuery(false, first, origin, direction, mask, 0u, LayerKey(0.0, 0u, 0u));
    searchTree(query, 0.0, tMax, mask);
    return query.sight.solid;
}

#endif
