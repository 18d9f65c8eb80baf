#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require
#include "trace/trace.glsl"

layout(location = 0) rayPayloadInEXT Hit record;

void main() { record = Hit(0.0, 0u, 0u, vec2(0.0)); }
