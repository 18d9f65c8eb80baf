#include "renderer_rt/passes/taa.hpp"

#include "renderer_rt/passes/check.hpp"

namespace q3rt {

void addTaa(FrameGraph& graph, ViewResources& resources, const ViewWork& work, TaaBuffers& buffers) {
    const BufferId history = graph.importBuffer("taa history", buffers.history);
    const BufferId previous = graph.importBuffer("taa previous history", buffers.previousHistory);
    resources.picture = graph.addPass(
        "taa",
        [&](PassBuilder& pass) {
            pass.read(resources.guides, access::kComputeRead);
            pass.read(resources.pasts, access::kComputeRead);
            pass.read(resources.picture, access::kComputeRead);
            pass.read(previous, access::kComputeRead);
            if (resources.gradients) pass.read(resources.gradients, access::kComputeRead);
            if (resources.exposure) pass.read(resources.exposure, access::kComputeRead);
            return pass.write(history, access::kComputeWrite);
        },
        [work, push = RtTaaPush{buffers.table}](PassContext& pass, BufferId) {
            work.pictures.dispatch(pass.commands(), PictureStage::Taa, push, work.area.extent);
        });
    checkFinite(graph, resources, "taa", resources.picture, kColorItem, work.area.extent);
}

} // namespace q3rt
