#include "renderer_rt/passes/trace_input.hpp"

namespace q3rt {

void addSort(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "sort",
        [&](PassBuilder& pass) {
            pass.read(resources.shadowBins, access::kComputeRead);
            resources.shadowOrder = pass.write(resources.shadowOrder, access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), PointStage::Sort, makeStageInput(pass, work));
        });
}

} // namespace q3rt
