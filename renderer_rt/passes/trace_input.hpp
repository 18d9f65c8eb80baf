#pragma once
// What a stage's dispatch binds, from the shared work of a view.

#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

inline StageInput makeStageInput(const PassContext& pass, const ViewWork& work) {
    StageInput input;
    input.textures = work.context.textures().set();
    if (work.view.top)
        input.structures =
            pass.makeSet(work.pipelines.structureLayout(), {bindAccelerationStructure(0, work.view.top->handle())});
    input.push = {work.view.frameSlice.address};
    input.extent = work.extent;
    input.stagedCover = work.view.stagedCover;
    return input;
}

} // namespace q3rt
