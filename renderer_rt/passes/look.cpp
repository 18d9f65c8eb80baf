#include "renderer_rt/passes/check.hpp"
#include "renderer_rt/passes/trace_input.hpp"

namespace q3rt {

void addLook(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "look",
        [&](PassBuilder& pass) {
            pass.read(resources.structures, work.pipelines.structureRead());
            if (resources.countsWork) resources.report = pass.write(resources.report, work.pipelines.bufferWrite());
            resources.looks = pass.write(resources.looks, work.pipelines.bufferWrite());
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), TraceStage::Look, makeStageInput(pass, work));
        });
    checkFinite(graph, resources, "look", resources.looks, kLookItem, work.extent);
}

} // namespace q3rt
