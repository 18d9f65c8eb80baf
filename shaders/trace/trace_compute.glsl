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
};

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
    // The search goes on a little behind the solid where layers are looked for.
    if (query.sight.solid.t > 0.0 && test.t >= query.sight.solid.t)
        return tMax;
    if ((flags & kBvhTriangleOpaque) == 0u &&
        !acceptHit(instance, number, test.barycentric, test.t, query.direction))
        return tMax;
    query.sight.solid = Hit(test.t, instance, number, test.barycentric);
    if (!query.first)
        return kBvhFound;
    return query.looks && query.layerMask != 0u ? min(tMax, layerReach(test.t, query.origin)) : test.t;
}

#include "trace/bvh_traverse.glsl"

uint groupsOf(uint mask)
{
    return ((mask & kMasksOfSolids) != 0u ? kBvhSolidGroup : 0u) |
           ((mask & ~kMasksOfSolids) != 0u ? kBvhOtherGroup : 0u);
}

Sight traceSight(vec3 origin, vec3 direction, float tMin, float tMax, uint solidMask, uint layerMask, LayerKey after)
{
    BvhQuery query = BvhQuery(true, true, solidMask, layerMask, origin, direction, Sight(noHit(), emptyBatch(after)));
    uint mask = solidMask | layerMask;
    traverseBvh(rtFrame.treeNodes, origin, direction, tMin, layerMask != 0u ? layerReach(tMax, origin) : tMax, mask,
                groupsOf(mask), query);
    return query.sight;
}

Hit traceSolid(vec3 origin, vec3 direction, float tMax, uint mask, bool first)
{
    BvhQuery query =
        BvhQuery(false, first, mask, 0u, origin, direction, Sight(noHit(), emptyBatch(LayerKey(0.0, 0u, 0u))));
    traverseBvh(rtFrame.treeNodes, origin, direction, 0.0, tMax, mask, groupsOf(mask), query);
    return query.sight.solid;
}

#endif
