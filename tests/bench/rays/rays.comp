// Traces given rays, no shading: the closest hit, or with ANY_HIT whether there is one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rays_push.h"
#include "trace/trace.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RayTable { BenchRay at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer ResultTable { float at[]; };
layout(push_constant, scalar) uniform Push { RaysPush push; };

// The names that the back end knows.
#define rtFrame push
uint coverAt(uint instance, uint triangle, vec2 barycentric) { return kCoverSolid; }
bool acceptHit(uint instance, uint triangle, vec2 barycentric, float t, vec3 direction) { return true; }
float layerDistance(uint instance, uint triangle, vec2 barycentric, float t, vec3 origin, vec3 direction)
{
    return -1.0;
}
float layerReach(float t, vec3 origin) { return t; }

#include "trace/trace_compute.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    if (gl_GlobalInvocationID.x >= push.width || gl_GlobalInvocationID.y >= push.height)
        return;
    uint index = gl_GlobalInvocationID.y * push.width + gl_GlobalInvocationID.x;
    BenchRay ray = RayTable(push.rays).at[index];
#ifdef ANY_HIT
    Hit hit = traceSolid(ray.origin, ray.direction, push.tMax, 0xffu, false);
#else
    Hit hit = traceSight(ray.origin, ray.direction, 0.0, push.tMax, 0xffu, 0u, LayerKey(0.0, 0u, 0u)).solid;
#endif
    ResultTable(push.results).at[index] = hit.t;
}
