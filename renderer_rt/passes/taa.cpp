#include "renderer_rt/passes/taa.hpp"

namespace q3rt {

void addTaa(FrameGraph& graph, ViewResources& resources, TaaBuffers& buffers, const ComputePipeline& pipeline,
            VkExtent2D extent) {
    const BufferId history = graph.importBuffer("taa history", buffers.history);
    const BufferId previous = graph.importBuffer("taa previous history", buffers.previousHistory);
    const RtTaaPush push{buffers.table};
    resources.picture = graph.addPass(
        "taa",
        [&](PassBuilder& pass) {
            pass.read(resources.guides, access::kComputeRead);
            pass.read(resources.pasts, access::kComputeRead);
            pass.read(resources.picture, access::kComputeRead);
            pass.read(previous, access::kComputeRead);
            if (resources.gradients) pass.read(resources.gradients, access::kComputeRead);
            return pass.write(history, access::kComputeWrite);
        },
        [&pipeline, push, extent](PassContext& pass, BufferId) {
            pipeline.bind(pass.commands());
            pipeline.push(pass.commands(), push);
            pipeline.dispatchOver(pass.commands(), extent);
        });
}

} // namespace q3rt
