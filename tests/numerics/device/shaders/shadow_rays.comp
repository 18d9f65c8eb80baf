#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef BACKEND_QUERY
#extension GL_EXT_ray_query : require
#endif
#include "rt/extensions.glsl"
#include "shadow_rays.glsl"
#ifdef BACKEND_QUERY
#include "trace/trace_query.glsl"
#else
#include "trace/trace_compute.glsl"
#endif
#include "shadow_one.glsl"

layout(local_size_x = 64) in;

void main() { shadowRay(gl_GlobalInvocationID.x); }
