#include "renderer_rt/passes/check.hpp"
#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

namespace {

void addAccumulateError(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "accumulate error",
        [&](PassBuilder& pass) {
            pass.read(resources.sums, access::kComputeRead);
            pass.read(resources.reference, access::kComputeRead);
            resources.report = pass.write(resources.report, access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pictures.dispatch(pass.commands(), PictureStage::AccumulateError, RtPush{work.view.frameSlice.address},
                                   work.extent);
        });
}

} // namespace

void addAccumulate(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "accumulate",
        [&](PassBuilder& pass) {
            pass.read(resources.pixels, access::kComputeRead);
            pass.read(resources.irradiance, access::kComputeRead);
            pass.read(resources.ambient, access::kComputeRead);
            if (resources.exposure) pass.read(resources.exposure, access::kComputeRead);
            resources.sums = pass.write(resources.sums, access::kComputeWrite);
            resources.radiance = pass.write(resources.radiance, access::kComputeWrite);
            resources.reference = pass.write(resources.reference, access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pictures.dispatch(pass.commands(), PictureStage::Accumulate, RtPush{work.view.frameSlice.address},
                                   work.extent);
        });
    checkFinite(graph, resources, "accumulate", resources.sums, kSumsItem, work.extent);
    // A single sample has no spread.
    if (resources.report && work.view.frame.sampleNumber > 0) addAccumulateError(graph, resources, work);
}

} // namespace q3rt
