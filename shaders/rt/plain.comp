// Plain shading of one pixel: back ends `query` and `compute` (BACKEND_QUERY, BACKEND_COMPUTE).
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef BACKEND_QUERY
#extension GL_EXT_ray_query : require
#endif
#include "rt/extensions.glsl"
#include "rt/scene.glsl"
#include "trace/trace.glsl"

// Whatever is not blended is solid.
uint coverAt(uint instance, uint triangle, vec2 barycentric) { return kCoverSolid; }
bool acceptHit(uint instance, uint triangle, vec2 barycentric, float t, vec3 direction) { return true; }
float layerDistance(uint instance, uint triangle, vec2 barycentric, float t, vec3 origin, vec3 direction)
{
    return -1.0;
}

#ifdef BACKEND_QUERY
#include "trace/trace_query.glsl"
#else
#include "trace/trace_compute.glsl"
#endif
#include "rt/plain.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    if (all(lessThan(gl_GlobalInvocationID.xy, rtFrame.size)))
        plainPixel(gl_GlobalInvocationID.xy);
}
