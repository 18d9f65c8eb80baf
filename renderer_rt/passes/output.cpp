#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

void addOutput(FrameGraph& graph, ViewResources& resources, FrameTargets& targets, const ViewWork& work,
               const OutputWork& output) {
    graph.addPass(
        "output",
        [&](PassBuilder& pass) {
            pass.read(resources.picture, access::kFragmentRead);
            if (resources.reference) pass.read(resources.reference, access::kFragmentRead);
            targets.color = pass.write(targets.color, access::kColorAttachment);
        },
        [work, output, color = targets.color](PassContext& pass) {
            const VkCommandBuffer commands = pass.commands();
            const Attachment attachment{.view = pass.view(color)};
            beginRendering(commands, pass.extent(color), {&attachment, 1});
            vkCmdSetScissor(commands, 0, 1, &output.drawn);
            work.pictures.output().bind(commands);
            work.pictures.output().push(commands, output.push);
            vkCmdDraw(commands, 3, 1, 0, 0);
            vkCmdEndRenderingKHR(commands);
        });
}

} // namespace q3rt
