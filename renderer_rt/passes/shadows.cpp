#include "renderer_rt/passes/trace_input.hpp"

namespace q3rt {

void addShadows(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "shadows",
        [&](PassBuilder& pass) {
            pass.read(resources.structures, work.pipelines.structureRead());
            if (resources.countsWork) resources.report = pass.write(resources.report, work.pipelines.bufferWrite());
            pass.read(resources.shadowRays, work.pipelines.bufferRead());
            pass.read(resources.shadowOrder, work.pipelines.bufferRead());
            resources.irradiance = pass.write(resources.irradiance, work.pipelines.bufferWrite());
            resources.lighting = resources.irradiance;
        },
        [work](PassContext& pass) {
            StageInput input = makeStageInput(pass, work);
            input.extent = wholeTiles(work.extent);
            work.pipelines.dispatch(pass.commands(), TraceStage::Shadows, input);
        });
}

} // namespace q3rt
