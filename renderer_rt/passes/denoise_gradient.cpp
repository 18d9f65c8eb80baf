#include "renderer_rt/passes/denoise.hpp"

#include "renderer_rt/passes/check.hpp"

namespace q3rt {

void addDenoiseGradient(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                        const DenoiseWork& work) {
    graph.addPass(
        "denoise gradient",
        [&](PassBuilder& pass) {
            pass.read(denoise.winners, access::kComputeRead);
            pass.read(denoise.previousIrradiance, access::kComputeRead);
            pass.read(resources.irradiance, access::kComputeRead);
            denoise.gradients[0] = pass.write(denoise.gradients[0], access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), DenoiseStage::Gradient, {.denoise = work.table},
                                    strataOf(work.extent));
        });
    checkFinite(graph, resources, "denoise gradient", denoise.gradients[0], kColorItem, strataOf(work.extent));
}

void addDenoiseGradientFilter(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                              const DenoiseWork& work) {
    for (uint32_t level = 0; level < kGradientLevels; ++level) {
        graph.addPass(
            "denoise gradient filter",
            [&](PassBuilder& pass) {
                pass.read(resources.guides, access::kComputeRead);
                pass.read(denoise.gradients[level & 1], access::kComputeRead);
                BufferId& to = denoise.gradients[(level + 1) & 1];
                to = pass.write(to, access::kComputeWrite);
            },
            [work, level](PassContext& pass) {
                work.pipelines.dispatch(pass.commands(), DenoiseStage::GradientFilter,
                                        {.denoise = work.table, .level = level}, strataOf(work.extent));
            });
        checkFinite(graph, resources, "denoise gradient filter", denoise.gradients[(level + 1) & 1], kColorItem,
                    strataOf(work.extent));
    }
}

} // namespace q3rt
