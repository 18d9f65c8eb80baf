#include "renderer_rt/passes/trace_input.hpp"

namespace q3rt {

void addComposite(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "composite",
        [&](PassBuilder& pass) {
            pass.read(resources.pixels, access::kComputeRead);
            pass.read(resources.lighting, access::kComputeRead);
            pass.read(resources.ambient, access::kComputeRead);
            resources.radiance = pass.write(resources.radiance, access::kComputeWrite);
            resources.means = pass.write(resources.means, access::kComputeWrite);
            resources.picture = pass.write(resources.picture, access::kComputeWrite);
        },
        [work](PassContext& pass) { work.pipelines.dispatchComposite(pass.commands(), makeStageInput(pass, work)); });
}

} // namespace q3rt
