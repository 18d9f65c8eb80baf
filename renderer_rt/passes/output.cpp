#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

void addOutput(FrameGraph& graph, ViewResources& resources, FrameTargets& targets, const ViewWork& work,
               const RtOutput& output) {
    graph.addPass(
        "output",
        [&](PassBuilder& pass) {
            pass.read(resources.picture, access::kComputeRead);
            if (resources.reference) pass.read(resources.reference, access::kComputeRead);
            targets.color = pass.write(targets.color, access::kComputeWrite);
        },
        [work, output, color = targets.color](PassContext& pass) {
            const VkDescriptorSet target =
                pass.makeSet(work.pictures.targetLayout(), {bindStorageImage(0, pass.view(color))});
            work.pictures.dispatchOutput(pass.commands(), target, output);
        });
}

} // namespace q3rt
