// Back end `query`: ray queries inside a compute shader.
#ifndef Q3RT_TRACE_QUERY_GLSL
#define Q3RT_TRACE_QUERY_GLSL
#include "shared/rt_scene.h"
#include "trace/trace.glsl"

layout(set = 1, binding = 0) uniform accelerationStructureEXT sceneStructure;

// Runs the accept function on every candidate until the query is settled.
void settleQuery(rayQueryEXT query, vec3 direction)
{
    while (rayQueryProceedEXT(query)) {
        if (acceptHit(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false),
                      rayQueryGetIntersectionPrimitiveIndexEXT(query, false),
                      rayQueryGetIntersectionBarycentricsEXT(query, false), rayQueryGetIntersectionTEXT(query, false),
                      direction))
            rayQueryConfirmIntersectionEXT(query);
    }
}

Hit findSolid(uint rayFlags, vec3 origin, vec3 direction, float tMin, float tMax, uint mask)
{
    rayQueryEXT query;
    rayQueryInitializeEXT(query, sceneStructure, rayFlags, mask, origin, tMin, direction, tMax);
    settleQuery(query, direction);
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT)
        return noHit();
    return Hit(rayQueryGetIntersectionTEXT(query, true), rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
               rayQueryGetIntersectionPrimitiveIndexEXT(query, true),
               rayQueryGetIntersectionBarycentricsEXT(query, true));
}

LayerBatch firstLayers(vec3 origin, vec3 direction, float tMin, float tMax, uint mask, LayerKey after)
{
    LayerBatch batch = emptyBatch(after);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, sceneStructure, gl_RayFlagsNoOpaqueEXT, mask, origin, tMin, direction, tMax);
    while (rayQueryProceedEXT(query)) {
        uint instance = rayQueryGetIntersectionInstanceCustomIndexEXT(query, false);
        uint triangle = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
        vec2 barycentric = rayQueryGetIntersectionBarycentricsEXT(query, false);
        float t = rayQueryGetIntersectionTEXT(query, false);
        float distance = layerDistance(instance, triangle, barycentric, t, origin, direction);
        if (distance > 0.0)
            insertLayer(batch, Layer(LayerKey(distance, instance, triangle), t, barycentric));
    }
    return batch;
}

Sight traceSight(vec3 origin, vec3 direction, float tMin, float tMax, uint solidMask, uint layerMask, LayerKey after)
{
    Sight sight = Sight(noHit(), emptyBatch(after));
    if (solidMask != 0u)
        sight.solid = findSolid(gl_RayFlagsCullBackFacingTrianglesEXT, origin, direction, tMin, tMax, solidMask);
    if (layerMask != 0u)
        sight.layers = firstLayers(origin, direction, tMin,
                                   layerReach(sight.solid.t > 0.0 ? sight.solid.t : tMax, origin), layerMask, after);
    return sight;
}

Hit traceSolid(vec3 origin, vec3 direction, float tMax, uint mask, bool first)
{
    return findSolid(first ? gl_RayFlagsNoneEXT : gl_RayFlagsTerminateOnFirstHitEXT, origin, direction, 0.0, tMax,
                        mask);
}

#endif
