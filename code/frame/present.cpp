#include "frame/present.hpp"

#include "frame/frame_executor.hpp"
#include "gpu/swapchain.hpp"

namespace q3rt {
namespace {

VkImageBlit wholeBlit(VkExtent2D from, VkExtent2D to) {
    const auto corner = [](VkExtent2D extent) {
        return VkOffset3D{static_cast<int32_t>(extent.width), static_cast<int32_t>(extent.height), 1};
    };
    const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    return {layers, {{0, 0, 0}, corner(from)}, layers, {{0, 0, 0}, corner(to)}};
}

} // namespace

void addPresent(FrameGraph& graph, ImageId picture, const Swapchain& swapchain) {
    ImageId window =
        graph.importForeign("window", swapchain.image(), swapchain.view(), {swapchain.extent(), swapchain.format()});
    const ImageId target = window;
    graph.addPass(
        "window",
        [&](PassBuilder& pass) {
            pass.read(picture, access::kTransferRead);
            window = pass.write(window, access::kTransferWrite);
        },
        [picture, target](PassContext& context) {
            const VkExtent2D from = context.extent(picture);
            const VkExtent2D to = context.extent(target);
            const bool sameSize = from.width == to.width && from.height == to.height;
            const VkImageBlit region = wholeBlit(from, to);
            vkCmdBlitImage(context.commands(), context.image(picture), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           context.image(target), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                           sameSize ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
        });
    graph.addPass(
        "present",
        [&](PassBuilder& pass) {
            pass.read(window, access::kPresent);
            pass.keep();
        },
        [](PassContext&) {});
}

} // namespace q3rt
