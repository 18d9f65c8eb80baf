#include "renderer_rt/passes/check.hpp"
#include "renderer_rt/passes/trace_input.hpp"

namespace q3rt {

void addPlain(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "plain",
        [&](PassBuilder& pass) {
            if (resources.countsWork) resources.report = pass.write(resources.report, work.pipelines.bufferWrite());
            pass.read(resources.structures, work.pipelines.structureRead());
            resources.picture = pass.write(resources.picture, work.pipelines.bufferWrite());
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), TraceStage::Plain, makeStageInput(pass, work));
        });
    checkFinite(graph, resources, "plain", resources.picture, kColorItem, work.extent);
}

} // namespace q3rt
