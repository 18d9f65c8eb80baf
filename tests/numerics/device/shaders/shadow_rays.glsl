// Shadow rays of given surface points, by any back end. Tables: see ShadowPush in shadow_push.h.
#include "lib/offset.glsl"
#include "shadow_push.h"
#include "trace/trace.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RayTable { ShadowInput at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer ResultTable { uint at[]; };
layout(push_constant, scalar) uniform Push { ShadowPush push; };

// The names that the back ends know.
#define rtFrame push
uint coverAt(uint instance, uint triangle, vec2 barycentric) { return kCoverSolid; }
bool acceptHit(uint instance, uint triangle, vec2 barycentric, float t, vec3 direction) { return true; }
float layerDistance(uint instance, uint triangle, vec2 barycentric, float t, vec3 origin, vec3 direction)
{
    return -1.0;
}
float layerReach(float t, vec3 origin) { return t; }
