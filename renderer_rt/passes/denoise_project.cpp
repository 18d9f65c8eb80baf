#include "renderer_rt/passes/denoise.hpp"

#include "renderer_rt/passes/check.hpp"

namespace q3rt {

void addDenoiseProject(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                       const DenoiseWork& work) {
    graph.addPass(
        "denoise clear",
        [&](PassBuilder& pass) { denoise.winners = pass.write(denoise.winners, access::kTransferWrite); },
        [winners = denoise.winners](PassContext& pass) {
            vkCmdFillBuffer(pass.commands(), pass.buffer(winners), 0, VK_WHOLE_SIZE, kNoWinner);
        });
    graph.addPass(
        "denoise project",
        [&](PassBuilder& pass) {
            pass.read(denoise.previousPixels, access::kComputeRead);
            pass.read(resources.previousGuides, access::kComputeRead);
            pass.read(resources.guides, access::kComputeRead);
            denoise.winners = pass.write(denoise.winners, access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), DenoiseStage::Project, {.denoise = work.table},
                                    strataOf(work.extent));
        });
}

void addDenoiseCarry(FrameGraph& graph, ViewResources& resources, const DenoiseResources& denoise,
                     const DenoiseWork& work) {
    graph.addPass(
        "denoise carry",
        [&](PassBuilder& pass) {
            pass.read(denoise.previousPixels, access::kComputeRead);
            pass.read(resources.previousGuides, access::kComputeRead);
            pass.read(denoise.winners, access::kComputeRead);
            resources.pixels = pass.write(resources.pixels, access::kComputeWrite);
            resources.guides = pass.write(resources.guides, access::kComputeWrite);
            resources.pasts = pass.write(resources.pasts, access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), DenoiseStage::Carry, {.denoise = work.table},
                                    strataOf(work.extent));
        });
    checkFinite(graph, resources, "denoise carry", resources.pixels, kPixelItem, work.extent);
    checkFinite(graph, resources, "denoise carry", resources.guides, kGuideItem, work.extent);
    checkFinite(graph, resources, "denoise carry", resources.pasts, kPastItem, work.extent);
}

} // namespace q3rt
