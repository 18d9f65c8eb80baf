#include "renderer_rt/passes/denoise.hpp"

#include "renderer_rt/passes/check.hpp"

namespace q3rt {

void addDenoiseVariance(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                        const DenoiseWork& work) {
    graph.addPass(
        "denoise variance",
        [&](PassBuilder& pass) {
            pass.read(resources.guides, access::kComputeRead);
            pass.read(denoise.light, access::kComputeRead);
            pass.read(denoise.moments, access::kComputeRead);
            denoise.filtered[0] = pass.write(denoise.filtered[0], access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pipelines.dispatch(pass.commands(), DenoiseStage::Variance, {.denoise = work.table}, work.extent);
        });
    checkFinite(graph, resources, "denoise variance", denoise.filtered[0], kColorItem, work.extent);
}

void addDenoiseFilter(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise, const DenoiseWork& work) {
    for (uint32_t level = 0; level < kFilterLevels; ++level) {
        graph.addPass(
            "denoise filter",
            [&](PassBuilder& pass) {
                pass.read(resources.guides, access::kComputeRead);
                pass.read(denoise.filtered[level & 1], access::kComputeRead);
                BufferId& to = denoise.filtered[(level + 1) & 1];
                to = pass.write(to, access::kComputeWrite);
            },
            [work, level](PassContext& pass) {
                work.pipelines.dispatch(pass.commands(), DenoiseStage::Filter, {.denoise = work.table, .level = level},
                                        work.extent);
            });
        checkFinite(graph, resources, "denoise filter", denoise.filtered[(level + 1) & 1], kColorItem, work.extent);
    }
}

} // namespace q3rt
