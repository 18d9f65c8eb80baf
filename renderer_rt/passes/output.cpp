#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

void addOutput(FrameGraph& graph, ViewResources& resources, FrameTargets& targets, const ViewWork& work,
               const RtOutput& output) {
    graph.addPass(
        "output",
        [&](PassBuilder& pass) {
            pass.read(resources.picture, access::kFragmentRead);
            targets.color = pass.write(targets.color, access::kColorAttachment);
        },
        [work, output, color = targets.color](PassContext& pass) {
            const VkCommandBuffer commands = pass.commands();
            const Attachment attachment{.view = pass.view(color)};
            beginRendering(commands, pass.extent(color), {&attachment, 1});
            const VkRect2D area{{static_cast<int32_t>(output.corner.x), static_cast<int32_t>(output.corner.y)},
                                work.extent};
            vkCmdSetScissor(commands, 0, 1, &area);
            work.pipelines.output().bind(commands);
            work.pipelines.output().push(commands, output);
            vkCmdDraw(commands, 3, 1, 0, 0);
            vkCmdEndRenderingKHR(commands);
        });
}

} // namespace q3rt
