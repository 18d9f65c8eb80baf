#include "renderer_rt/passes/denoise.hpp"

#include "renderer_rt/passes/check.hpp"

namespace q3rt {

void addDenoiseTemporal(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                        const DenoiseWork& work) {
    graph.addPass(
        "denoise temporal",
        [&](PassBuilder& pass) {
            pass.read(resources.irradiance, access::kComputeRead);
            pass.read(resources.guides, access::kComputeRead);
            if (work.hasHistory) {
                pass.read(resources.pasts, access::kComputeRead);
                pass.read(resources.previousGuides, access::kComputeRead);
                pass.read(denoise.previousLight, access::kComputeRead);
                pass.read(denoise.previousMoments, access::kComputeRead);
            }
            if (work.hasGradient) pass.read(denoise.gradients[kGradientLevels & 1], access::kComputeRead);
            denoise.light = pass.write(denoise.light, access::kComputeWrite);
            denoise.moments = pass.write(denoise.moments, access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), DenoiseStage::Temporal, {.denoise = work.table}, work.extent);
        });
    checkFinite(graph, resources, "denoise temporal", denoise.light, kColorItem, work.extent);
    checkFinite(graph, resources, "denoise temporal", denoise.moments, kPairItem, work.extent);
}

} // namespace q3rt
