// Presentation, on a surface without a display (VK_EXT_headless_surface).

#include <unistd.h>

#include "frame/frame_executor.hpp"
#include "frame/present.hpp"
#include "gpu/readback.hpp"
#include "gpu/swapchain.hpp"
#include "gpu_test.hpp"

namespace q3rt {
namespace {

VkSurfaceKHR createHeadlessSurface(VkInstance instance) {
    VkHeadlessSurfaceCreateInfoEXT create{VK_STRUCTURE_TYPE_HEADLESS_SURFACE_CREATE_INFO_EXT};
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    vkCheck(vkCreateHeadlessSurfaceEXT(instance, &create, nullptr, &surface), "vkCreateHeadlessSurfaceEXT");
    return surface;
}

class SwapchainTest : public GpuTest {
  protected:
    DeviceOptions options() override {
        return {.validation = true,
                .instanceExtensions = {VK_KHR_SURFACE_EXTENSION_NAME, VK_EXT_HEADLESS_SURFACE_EXTENSION_NAME},
                .createSurface = createHeadlessSurface};
    }
};

void addGreen(FrameGraph& graph, ImageId& picture) {
    graph.addPass(
        "clear", [&](PassBuilder& pass) { picture = pass.write(picture, access::kTransferWrite); },
        [picture](PassContext& context) {
            const VkClearColorValue green{.float32 = {0, 1, 0, 1}};
            const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            vkCmdClearColorImage(context.commands(), context.image(picture), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                 &green, 1, &all);
        });
}

TEST_F(SwapchainTest, FramesArePresentedThroughNewSizesAndALostSurface) {
    FrameRing ring(device());
    FrameExecutor executor(device());
    for (const int interval : {1, 0, -1}) {
        Swapchain swapchain(device(), {64, 48}, interval);
        for (uint32_t frame = 0; frame < 6; ++frame) {
            const VkExtent2D size{64 + 16 * (frame / 3), 48};
            OffscreenTarget target(device(), {32, 32});
            ring.begin();
            if (frame == 4) swapchain.loseSurface();
            ASSERT_TRUE(swapchain.acquire(size));
            FrameGraph graph;
            ImageId picture = graph.importImage("picture", target.image());
            addGreen(graph, picture);
            addPresent(graph, picture, swapchain);
            executor.run(graph, ring);
            ring.submit(&swapchain, frame % 2 == 0 ? Show::WithNextFrame : Show::AtOnce);
            EXPECT_FALSE(swapchain.acquired());
        }
    }
}

// An error between acquire and submit: each such frame once took an image away, and the fifth waited for ever.
TEST_F(SwapchainTest, AbandonedFramesGiveTheirImageBack) {
    constexpr unsigned kHangsSeconds = 60;
    alarm(kHangsSeconds); // to wait for ever is to fail
    FrameRing ring(device());
    FrameExecutor executor(device());
    Swapchain swapchain(device(), {64, 48}, 0);
    OffscreenTarget target(device(), {32, 32});
    constexpr int kFrames = 16, kPresentedEach = 8;
    for (int frame = 0; frame < kFrames; ++frame) {
        ring.begin();
        ASSERT_TRUE(swapchain.acquire({64, 48}));
        FrameGraph graph;
        ImageId picture = graph.importImage("picture", target.image());
        addGreen(graph, picture);
        addPresent(graph, picture, swapchain);
        if (frame % kPresentedEach == kPresentedEach - 1) {
            executor.run(graph, ring);
            ring.submit(&swapchain, Show::WithNextFrame);
        } else {
            ring.abandon();
            swapchain.abandonImage();
        }
        EXPECT_FALSE(swapchain.acquired());
    }
    alarm(0);
}

} // namespace
} // namespace q3rt
