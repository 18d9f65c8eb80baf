#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "trace/trace.glsl"

layout(location = 0) rayPayloadInEXT Hit record;

void main() { record = noHit(); }
