// Counts what a frame did beyond opaque surfaces lit by lamps, by kind (rt_countWork).
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

#endif
