#include "renderer_rt/passes/check.hpp"
#include "renderer_rt/passes/trace_input.hpp"

namespace q3rt {

void addPrimary(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "primary",
        [&](PassBuilder& pass) {
            pass.read(resources.structures, work.pipelines.structureRead());
            if (resources.countsWork) resources.report = pass.write(resources.report, work.pipelines.bufferWrite());
            pass.read(resources.looks, work.pipelines.bufferRead());
            resources.pixels = pass.write(resources.pixels, work.pipelines.bufferWrite());
            if (!resources.guides) return;
            resources.guides = pass.write(resources.guides, work.pipelines.bufferWrite());
            resources.pasts = pass.write(resources.pasts, work.pipelines.bufferWrite());
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), TraceStage::Primary, makeStageInput(pass, work));
        });
    checkFinite(graph, resources, "primary", resources.pixels, kPixelItem, work.extent);
    if (!resources.guides) return;
    checkFinite(graph, resources, "primary", resources.guides, kGuideItem, work.extent);
    checkFinite(graph, resources, "primary", resources.pasts, kPastItem, work.extent);
}

} // namespace q3rt
