// Back end `compute`: our own two-level tree in a compute shader. Needs nothing beyond Vulkan 1.2.
#ifndef Q3RT_TRACE_COMPUTE_GLSL
#define Q3RT_TRACE_COMPUTE_GLSL
#include "shared/bvh.h"
#include "shared/rt_scene.h"
#include "trace/trace.glsl"
#include "lib/intersect.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer BvhNodeTable { BvhNode at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer BvhTriangleTable { BvhTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer BvhInstanceTable { BvhInstance at[]; };

BvhNode loadBvhNode(uvec2 table, uint index) { return BvhNodeTable(table).at[index]; }
BvhTriangle loadBvhTriangle(uvec2 table, uint index) { return BvhTriangleTable(table).at[index]; }
const uint kSearchHit = 0u;    // `hit` is the last triangle that counted
const uint kSearchLayers = 1u; // nothing counts, everything is collected

struct BvhQuery {
    uint kind; // a literal at every call: the other kind's code and data fold away
    bool cullBack;
    vec3 origin;
    vec3 direction;
    Hit hit;
    LayerBatch batch;
};

// Instances are stored in the leaf order of the scene tree.
BvhInstance loadBvhInstance(inout BvhQuery query, uint item) {
    return BvhInstanceTable(rtFrame.treeInstances).at[item];
}

bool onBvhTriangle(inout BvhQuery query, BvhInstance instance, BvhTriangle triangle, TriangleHit test)
{
    if (query.kind == kSearchLayers) {
        float distance = layerDistance(instance.customIndex, triangle.number, test.barycentric, test.t, query.origin,
                                       query.direction);
        if (distance > 0.0)
            insertLayer(query.batch, Layer(LayerKey(distance, instance.customIndex, triangle.number), test.t,
                                           test.barycentric));
        return false;
    }
    if (query.cullBack && instance.cullBack != 0u && !test.frontFace)
        return false;
    if (triangle.opaque == 0u &&
        !acceptHit(instance.customIndex, triangle.number, test.barycentric, test.t, query.direction))
        return false;
    query.hit = Hit(test.t, instance.customIndex, triangle.number, test.barycentric);
    return true;
}

#include "trace/bvh_traverse.glsl"

BvhQuery beginQuery(uint kind, vec3 origin, vec3 direction, bool cullBack)
{
    BvhQuery query;
    query.kind = kind;
    query.cullBack = cullBack;
    query.origin = origin;
    query.direction = direction;
    query.hit = Hit(0.0, 0u, 0u, vec2(0.0));
    return query;
}

Hit traceClosest(vec3 origin, vec3 direction, float tMin, float tMax, uint mask, bool cullBack)
{
    BvhQuery query = beginQuery(kSearchHit, origin, direction, cullBack);
    traverseBvh(rtFrame.treeNodes, origin, direction, tMin, tMax, mask, false, query);
    return query.hit;
}

bool traceVisible(vec3 origin, vec3 direction, float tMax, uint mask)
{
    BvhQuery query = beginQuery(kSearchHit, origin, direction, false);
    traverseBvh(rtFrame.treeNodes, origin, direction, 0.0, tMax, mask, true, query);
    return query.hit.t == 0.0;
}

LayerBatch traceLayers(vec3 origin, vec3 direction, float tMax, uint mask, LayerKey after)
{
    BvhQuery query = beginQuery(kSearchLayers, origin, direction, false);
    query.batch = emptyBatch(after);
    traverseBvh(rtFrame.treeNodes, origin, direction, after.distance, tMax, mask, false, query);
    return query.batch;
}

#endif
