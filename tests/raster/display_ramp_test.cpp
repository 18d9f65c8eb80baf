// The ramp over a finished picture, as the window gets it, against its table byte by byte.

#include <algorithm>

#include "frame/frame_executor.hpp"
#include "gpu/gpu_test.hpp"
#include "gpu/readback.hpp"
#include "gpu/uploader.hpp"
#include "renderer_vk/display_ramp.hpp"
#include "scene/texture_upload.hpp"

namespace q3rt {
namespace {

constexpr VkExtent2D kSize{32, 8}; ///< a pixel for each byte

class DisplayRampTest : public GpuTest {};

std::vector<uint8_t> everyByte() {
    std::vector<uint8_t> rgba;
    for (int i = 0; i < 256; ++i)
        for (const int value : {i, 255 - i, i * 7 % 256, 255})
            rgba.push_back(static_cast<uint8_t>(value));
    return rgba;
}

GpuImage makePicture(Device& device, const char* name) {
    return GpuImage(
        device,
        {.extent = kSize, .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, .name = name});
}

ImageId addCopy(FrameGraph& graph, ImageId from, ImageId to) {
    graph.addPass(
        "copy",
        [&](PassBuilder& pass) {
            pass.read(from, access::kTransferRead);
            to = pass.write(to, access::kTransferWrite);
        },
        [from, to](PassContext& pass) {
            const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            const VkImageCopy region{layers, {}, layers, {}, {kSize.width, kSize.height, 1}};
            vkCmdCopyImage(pass.commands(), pass.image(from), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pass.image(to),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        });
    return to;
}

TEST_F(DisplayRampTest, ShowsWhatItsTableSays) {
    const std::vector<uint8_t> bytes = everyByte();
    GpuImage picture = makePicture(device(), "picture"), screen = makePicture(device(), "screen");
    Uploader uploader(device());
    uploader.upload(picture, std::as_bytes(std::span(bytes)));
    uploader.flush();
    FrameRing ring(device());
    FrameExecutor executor(device());
    DisplayRamp ramp(device(), kSize, screen.format());
    for (const auto& [gamma, overbrightBits] :
         {std::pair(1.0f, 0), {1.0f, 1}, {1.0f, 2}, {1.5f, 1}, {0.7f, 0}, {1.0f, 1}}) {
        const RampTable table = buildGammaTable(gamma, overbrightBits);
        ramp.follow(table);
        ring.begin();
        FrameGraph graph;
        ImageId shown = graph.importImage("screen", screen);
        shown = addCopy(graph, ramp.addTable(graph, graph.importImage("picture", picture)), shown);
        ramp.addDoublings(graph, shown);
        executor.run(graph, ring);
        ring.submit();
        const std::vector<std::byte> seen = readImage(device(), screen);
        ASSERT_EQ(seen.size(), bytes.size());
        for (size_t i = 0; i < bytes.size(); ++i) {
            if (i % 4 == 3) continue; // nobody reads alpha
            ASSERT_EQ(std::to_integer<int>(seen[i]), table[bytes[i]])
                << "byte " << int{bytes[i]} << ", gamma " << gamma << ", bits " << overbrightBits;
        }
    }
}

TEST(DisplayRampTable, IsKnownByItsDoublings) {
    EXPECT_EQ(doublingsOf(buildGammaTable(1.0f, 0)), 0);
    EXPECT_EQ(doublingsOf(buildGammaTable(1.0f, 2)), 2);
    EXPECT_EQ(doublingsOf(buildGammaTable(1.2f, 1)), std::nullopt);
    EXPECT_EQ(doublingsOf(RampTable{}), std::nullopt) << "black is no doubling";
}

} // namespace
} // namespace q3rt
