// Back end `pipeline`: hit shaders only fill a record, or call the shared functions of the stage.
#ifndef Q3RT_TRACE_PIPELINE_GLSL
#define Q3RT_TRACE_PIPELINE_GLSL
#include "shared/rt_scene.h"
#include "trace/trace.glsl"

layout(set = 1, binding = 0) uniform accelerationStructureEXT sceneStructure;
layout(location = 0) rayPayloadEXT Hit recordPayload;
layout(location = 1) rayPayloadEXT LayerBatch layersPayload;

Sight traceSight(vec3 origin, vec3 direction, float tMin, float tMax, uint solidMask, uint layerMask, LayerKey after)
{
    recordPayload = noHit();
    if (solidMask != 0u)
        traceRayEXT(sceneStructure, gl_RayFlagsCullBackFacingTrianglesEXT, solidMask, kHitGroupRecord, 0u, kMissRecord,
                    origin, tMin, direction, tMax, 0);
    layersPayload = emptyBatch(after);
    if (layerMask != 0u)
        traceRayEXT(sceneStructure, gl_RayFlagsNoOpaqueEXT | gl_RayFlagsSkipClosestHitShaderEXT, layerMask,
                    kHitGroupLayers, 0u, kMissLayers, origin, tMin, direction,
                    layerReach(recordPayload.t > 0.0 ? recordPayload.t : tMax, origin), 1);
    return Sight(recordPayload, layersPayload);
}

Hit traceSolid(vec3 origin, vec3 direction, float tMax, uint mask, bool first)
{
    recordPayload = noHit();
    traceRayEXT(sceneStructure, first ? gl_RayFlagsNoneEXT : gl_RayFlagsTerminateOnFirstHitEXT, mask, kHitGroupRecord,
                0u, kMissRecord, origin, 0.0, direction, tMax, 0);
    return recordPayload;
}

#endif
