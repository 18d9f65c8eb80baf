#include "renderer_rt/passes/trace_input.hpp"

namespace q3rt {

void addShade(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "shade",
        [&](PassBuilder& pass) {
            if (resources.countsWork) resources.report = pass.write(resources.report, access::kComputeWrite);
            resources.looks = pass.write(resources.looks, access::kComputeWrite);
            resources.pixels = pass.write(resources.pixels, access::kComputeWrite);
            if (!resources.guides) return;
            resources.guides = pass.write(resources.guides, access::kComputeWrite);
            resources.pasts = pass.write(resources.pasts, access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), PointStage::Shade, makeStageInput(pass, work));
        });
}

} // namespace q3rt
