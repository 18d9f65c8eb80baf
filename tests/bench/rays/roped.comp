// The same rays without a stack: boxes in depth-first order, each with a link to what comes after all that it holds
// (skip links; Smits 1998, "Efficiency Issues for Ray Tracing"). The closest hit, or with ANY_HIT whether there is one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "rt/extensions.glsl"
#include "rays_push.h"
#include "lib/intersect.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RayTable { BenchRay at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer ResultTable { float at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer BoxTable { RopedBox at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer TriangleTable { BvhTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer InstanceTable { BvhInstance at[]; };
layout(push_constant, scalar) uniform Push { RaysPush push; };

layout(local_size_x = 8, local_size_y = 8) in;

bool meets(RopedBox box, SlabRay ray, float tMax)
{
    vec3 near = mix(box.low, box.high, lessThan(ray.reciprocal, vec3(0.0)));
    vec3 far = mix(box.high, box.low, lessThan(ray.reciprocal, vec3(0.0)));
    vec3 enter = near * ray.reciprocal + ray.enter, leave = far * ray.reciprocal + ray.leave;
    return max(max(enter.x, enter.y), max(enter.z, 0.0)) <= min(min(leave.x, leave.y), min(leave.z, tMax));
}

float trace(BenchRay ray)
{
    vec3 reciprocal = slabReciprocal(ray.direction);
    SlabRay slabs = makeSlabRay(ray.origin, reciprocal, push.reach);
    TriangleRay triangleRay = makeTriangleRay(ray.origin, ray.direction, reciprocal);
    TriangleTable triangles = TriangleTable(InstanceTable(push.treeInstances).at[0].triangles);
    float tMax = push.tMax, found = 0.0;
    for (uint i = 0u; i < push.boxCount;) {
        RopedBox box = BoxTable(push.treeNodes).at[i];
        if (!meets(box, slabs, tMax)) {
            i = box.skip;
            continue;
        }
        ++i;
        uint first = box.leaf & kBvhItemMask, count = (box.leaf & ~kBvhLeafBit) >> kBvhCountShift;
        for (uint k = first; k < first + count; ++k) {
            BvhTriangle at = triangles.at[k];
            TriangleHit hit = intersectTriangle(triangleRay, componentsOf(at.corner0, triangleRay.axes),
                                                componentsOf(at.corner1, triangleRay.axes),
                                                componentsOf(at.corner2, triangleRay.axes), 0.0, tMax);
            if (!hit.hit)
                continue;
            tMax = hit.t;
            found = hit.t;
#ifdef ANY_HIT
            return found;
#endif
        }
    }
    return found;
}

void main()
{
    if (gl_GlobalInvocationID.x >= push.width || gl_GlobalInvocationID.y >= push.height)
        return;
    uint index = gl_GlobalInvocationID.y * push.width + gl_GlobalInvocationID.x;
    ResultTable(push.results).at[index] = trace(RayTable(push.rays).at[index]);
}
