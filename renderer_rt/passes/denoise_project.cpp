#include "renderer_rt/passes/denoise.hpp"

namespace q3rt {

DenoiseResources importDenoise(FrameGraph& graph, DenoiseBuffers& buffers) {
    DenoiseResources out;
    out.previousPixels = graph.importBuffer("previous pixels", buffers.previousPixels);
    out.previousIrradiance = graph.importBuffer("previous irradiance", buffers.previousIrradiance);
    out.light = graph.importBuffer("light", buffers.light);
    out.previousLight = graph.importBuffer("previous light", buffers.previousLight);
    out.moments = graph.importBuffer("moments", buffers.moments);
    out.previousMoments = graph.importBuffer("previous moments", buffers.previousMoments);
    out.winners = graph.importBuffer("winners", buffers.winners);
    for (size_t i = 0; i < 2; ++i) {
        out.gradients[i] = graph.importBuffer("gradients", buffers.gradients[i]);
        out.filtered[i] = graph.importBuffer("filtered", buffers.filtered[i]);
    }
    return out;
}

void addDenoiseProjection(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                          const DenoiseWork& work) {
    if (!work.hasHistory) return;
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
}

} // namespace q3rt
