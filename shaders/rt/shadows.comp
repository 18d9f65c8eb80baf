// Shadows of the chosen lights: back ends `query` and `compute` (BACKEND_QUERY,
// BACKEND_COMPUTE).
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef BACKEND_QUERY
#extension GL_EXT_ray_query : require
#endif
#include "rt/extensions.glsl"
#include "rt/accept.glsl"
#ifdef BACKEND_QUERY
#include "trace/trace_query.glsl"
#else
#include "trace/trace_compute.glsl"
#endif
#include "rt/shadows.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() { traceListed(gl_GlobalInvocationID.xy); }
