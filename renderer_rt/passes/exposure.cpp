#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

void addExposureAdapt(FrameGraph& graph, ViewResources& resources, const ViewWork& work, const ExposureStep& step) {
    if (step.first)
        graph.addPass(
            "exposure clear",
            [&](PassBuilder& pass) { resources.exposure = pass.write(resources.exposure, access::kTransferWrite); },
            [exposure = resources.exposure](PassContext& pass) {
                vkCmdFillBuffer(pass.commands(), pass.buffer(exposure), 0, VK_WHOLE_SIZE, 0);
            });
    graph.addPass(
        "exposure adapt",
        [&](PassBuilder& pass) { resources.exposure = pass.write(resources.exposure, access::kComputeWrite); },
        [work, mostStops = step.mostStops, exposure = resources.exposure](PassContext& pass) {
            const RtExposurePush push{work.view.frameSlice.address, pass.address(exposure), mostStops, 0};
            work.pictures.dispatchGroups(pass.commands(), PictureStage::ExposureAdapt, push, 1);
        });
}

void addExposureCount(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "exposure count",
        [&](PassBuilder& pass) {
            pass.read(resources.radiance, access::kComputeRead);
            resources.exposure = pass.write(resources.exposure, access::kComputeWrite);
        },
        [work, exposure = resources.exposure](PassContext& pass) {
            const RtExposurePush push{work.view.frameSlice.address, pass.address(exposure), 0, 0};
            work.pictures.dispatch(pass.commands(), PictureStage::ExposureCount, push, work.extent);
        });
}

} // namespace q3rt
