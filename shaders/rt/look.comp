// First look, one camera ray a pixel: back ends `query` and `compute` (BACKEND_QUERY, BACKEND_COMPUTE).
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef BACKEND_QUERY
#extension GL_EXT_ray_query : require
#endif
#include "rt/extensions.glsl"
// Is there any?
#define LAYERS_PER_BATCH 1u
#include "rt/accept.glsl"
#ifdef BACKEND_QUERY
#include "trace/trace_query.glsl"
#else
#include "trace/trace_compute.glsl"
#endif
#include "rt/look.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    if (all(lessThan(gl_GlobalInvocationID.xy, rtFrame.size)))
        lookPixel(gl_GlobalInvocationID.xy);
}
