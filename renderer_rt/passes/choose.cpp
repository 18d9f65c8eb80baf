#include "renderer_rt/passes/check.hpp"
#include "renderer_rt/passes/trace_input.hpp"

namespace q3rt {

void addChoose(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "choose",
        [&](PassBuilder& pass) {
            pass.read(resources.pixels, access::kComputeRead);
            resources.shadowRays = pass.write(resources.shadowRays, access::kComputeWrite);
            resources.shadowBins = pass.write(resources.shadowBins, access::kComputeWrite);
            resources.irradiance = pass.write(resources.irradiance, access::kComputeWrite);
            resources.ambient = pass.write(resources.ambient, access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), PointStage::Choose, makeStageInput(pass, work));
        });
    checkFinite(graph, resources, "choose", resources.irradiance, kColorItem, work.extent);
    checkFinite(graph, resources, "choose", resources.ambient, kColorItem, work.extent);
}

} // namespace q3rt
