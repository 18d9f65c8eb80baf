#pragma once
// What a stage's dispatch binds, from the shared work of a view.

#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

inline StageInput makeStageInput(const PassContext& pass, const ViewWork& work) {
    return {.textures = work.context.textures().set(),
            .structures =
                pass.makeSet(work.pipelines.structureLayout(), {bindAccelerationStructure(0, work.view.top->handle())}),
            .push = {work.view.frameSlice.address},
            .extent = work.extent};
}

} // namespace q3rt
