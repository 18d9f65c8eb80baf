#include "renderer_rt/passes/check.hpp"
#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

void addComposite(FrameGraph& graph, ViewResources& resources, const ViewWork& work) {
    graph.addPass(
        "composite",
        [&](PassBuilder& pass) {
            pass.read(resources.pixels, access::kComputeRead);
            pass.read(resources.lighting, access::kComputeRead);
            pass.read(resources.ambient, access::kComputeRead);
            if (resources.exposure) pass.read(resources.exposure, access::kComputeRead);
            resources.radiance = pass.write(resources.radiance, access::kComputeWrite);
            resources.picture = pass.write(resources.picture, access::kComputeWrite);
        },
        [work](PassContext& pass) {
            work.pictures.dispatch(pass.commands(), PictureStage::Composite, RtPush{work.view.frameSlice.address},
                                   work.extent);
        });
    checkFinite(graph, resources, "composite", resources.picture, kColorItem, work.extent);
}

} // namespace q3rt
