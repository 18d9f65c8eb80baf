// Counts what a frame did beyond opaque surfaces lit by lamps, by kind (rt_countWork), and its rays.
#ifndef Q3RT_RT_WORK_GLSL
#define Q3RT_RT_WORK_GLSL
#include "rt/scene.glsl"
#include "shared/rt_report.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer WorkTable { RtReport value; };

void countWork(uint kind, uint count)
{
    if ((rtFrame.flags & kFrameCountWork) != 0u)
        atomicAdd(WorkTable(rtFrame.report).value.work[kind], count);
}
void countWork(uint kind) { countWork(kind, 1u); }

// Of this invocation.
uint rayCount = 0u;

void countRay() { ++rayCount; }

// Ends a stage. Neighbours count in words of their own: they need not wait for each other.
void reportRays(uvec2 pixel)
{
    if ((rtFrame.flags & kFrameCountRays) != 0u)
        atomicAdd(WorkTable(rtFrame.report).value.rays[(pixel.y & 15u) * 16u + (pixel.x & 15u)], rayCount);
}

#endif
