// Whole frames: graph, executor, ring, timers, raster to an offscreen target, readback, history images.

#include <cstring>

#include "frame/frame_executor.hpp"
#include "gpu/graphics_pipeline.hpp"
#include "gpu/growing_buffer.hpp"
#include "gpu/readback.hpp"
#include "gpu_test.hpp"
#include "spirv/shaders_triangle_frag.hpp"
#include "spirv/shaders_triangle_vert.hpp"

namespace q3rt {
namespace {

constexpr VkExtent2D kSize{64, 32};

class FrameTest : public GpuTest {};

ImageId addTriangle(FrameGraph& graph, ImageId target, const GraphicsPipeline& pipeline) {
    ImageId drawn;
    graph.addPass(
        "triangle", [&](PassBuilder& pass) { drawn = pass.write(target, access::kColorAttachment); },
        [&pipeline, target](PassContext& context) {
            const Attachment color{
                context.view(target), VK_ATTACHMENT_LOAD_OP_CLEAR, {.color = {.float32 = {0, 0, 1, 1}}}};
            beginRendering(context.commands(), context.extent(target), color);
            pipeline.bind(context.commands());
            vkCmdDraw(context.commands(), 3, 1, 0, 0);
            vkCmdEndRenderingKHR(context.commands());
        });
    return drawn;
}

/// A transient image, cleared.
ImageId addGreen(FrameGraph& graph) {
    return graph.addPass(
        "clear", [&](PassBuilder& pass) { return pass.create("first", {kSize}, access::kTransferWrite); },
        [](PassContext& context, ImageId made) {
            const VkClearColorValue green{.float32 = {0, 1, 0, 1}};
            const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            vkCmdClearColorImage(context.commands(), context.image(made), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &green,
                                 1, &all);
        });
}

ImageId addCopy(FrameGraph& graph, const char* name, ImageId from, ImageId to) {
    ImageId copied;
    graph.addPass(
        name,
        [&](PassBuilder& pass) {
            pass.read(from, access::kTransferRead);
            copied = pass.write(to, access::kTransferWrite);
        },
        [from, to](PassContext& context) {
            const VkImageSubresourceLayers layers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            const VkExtent2D extent = context.extent(from);
            const VkImageCopy region{layers, {}, layers, {}, {extent.width, extent.height, 1}};
            vkCmdCopyImage(context.commands(), context.image(from), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           context.image(to), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        });
    return copied;
}

TEST_F(FrameTest, TriangleIsDrawnAndReadBack) {
    FrameRing ring(device());
    FrameExecutor executor(device());
    OffscreenTarget target(device(), kSize);
    const GraphicsPipeline pipeline(
        device(),
        {.name = "triangle", .vertex = {shaders::shaders_triangle_vert}, .fragment = {shaders::shaders_triangle_frag}});
    ring.begin();
    FrameGraph graph;
    addTriangle(graph, graph.importImage("target", target.image()), pipeline);
    executor.run(graph, ring);
    ring.submit();
    const std::vector<std::byte> rows = target.readRows();
    ASSERT_EQ(rows.size(), size_t{kSize.width} * kSize.height * 4);
    size_t orange = 0, blue = 0;
    for (size_t i = 0; i < rows.size(); i += 4) {
        orange += rows[i] == std::byte{255} && rows[i + 2] == std::byte{0};
        blue += rows[i] == std::byte{0} && rows[i + 2] == std::byte{255};
    }
    // The edge from (-1, -1) to (0, 1) cuts a quarter off the target, which spans 2 x 2.
    EXPECT_EQ(orange + blue, rows.size() / 4);
    EXPECT_NEAR(static_cast<double>(orange) / static_cast<double>(orange + blue), 0.25, 0.02);
}

TEST_F(FrameTest, FramesInFlightReuseTransientsAndReportTimes) {
    FrameRing ring(device());
    FrameExecutor executor(device());
    OffscreenTarget target(device(), kSize);
    ImageReadback readback(device(), ring.framesInFlight());
    GrowingBuffer scratch(device(), {.size = 64, .domain = MemoryDomain::Upload}, ring.framesInFlight());
    const GraphicsPipeline pipeline(
        device(),
        {.name = "triangle", .vertex = {shaders::shaders_triangle_vert}, .fragment = {shaders::shaders_triangle_frag}});
    size_t timed = 0;
    std::vector<std::byte> last;
    for (int frame = 0; frame < 8; ++frame) {
        ring.begin();
        scratch.beginFrame(ring.slot());
        for (uint32_t i = 0; i < 40; ++i) {
            const BufferSlice slice = scratch.append(i);
            uint32_t back = 0;
            std::memcpy(&back, slice.mapped, sizeof(back));
            ASSERT_EQ(back, i);
        }
        FrameGraph graph;
        const ImageId out = graph.importImage("target", target.image());
        const ImageId first = addGreen(graph);
        graph.addPass(
            "nobody needs", [&](PassBuilder& pass) { (void)pass.create("unused", {kSize}, access::kTransferWrite); },
            [](PassContext&) { FAIL() << "a dropped pass ran"; });
        const ImageId second = addTriangle(graph, first, pipeline);
        const ImageId copied = addCopy(graph, "copy", second, out);
        graph.addPass(
            "readback",
            [&](PassBuilder& pass) {
                pass.read(copied, access::kTransferRead);
                pass.keep();
            },
            [&](PassContext& context) {
                readback.record(context.commands(), ring, context.image(copied), context.format(copied),
                                context.extent(copied));
            });
        executor.run(graph, ring);
        ring.submit();
        EXPECT_EQ(executor.cachedCount(), 1u) << graph.print();
        if (ring.timers().results().empty()) continue;
        ++timed;
        ASSERT_EQ(ring.timers().results().size(), 4u);
        EXPECT_EQ(ring.timers().results()[0].name, "clear");
        EXPECT_EQ(ring.timers().results()[3].name, "readback");
        for (const TimerRow& row : ring.timers().results())
            EXPECT_GE(row.ms, 0.0) << row.name;
    }
    last = readback.collect(ring, ring.frameNumber());
    EXPECT_EQ(last, target.readRows());
    EXPECT_EQ(timed, device().capabilities().timestampBits ? 6u : 0u);
    EXPECT_GE(scratch.capacity(), 40u * 16u);
}

TEST_F(FrameTest, HistoryIsKeptBetweenFrames) {
    FrameRing ring(device());
    FrameExecutor executor(device());
    const ImageInfo info{.extent = kSize, .name = "history"};
    GpuImage history(device(), info);
    OffscreenTarget target(device(), kSize);
    for (int frame = 0; frame < 4; ++frame) {
        ring.begin();
        FrameGraph graph;
        const ImageId old = graph.importImage("history", history);
        ImageId out = graph.importImage("target", target.image());
        if (frame > 0) out = addCopy(graph, "from history", old, out);
        graph.addPass(
            "to history", [&](PassBuilder& pass) { (void)pass.write(old, access::kTransferWrite); },
            [old, frame](PassContext& context) {
                const VkClearColorValue grey{.float32 = {static_cast<float>(frame + 1) / 255.0f, 0, 0, 1}};
                const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
                vkCmdClearColorImage(context.commands(), context.image(old), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                     &grey, 1, &all);
            });
        executor.run(graph, ring);
        ring.submit();
    }
    EXPECT_EQ(target.readRows()[0], std::byte{3}) << "the third frame's value is what the fourth copied";
}

TEST_F(FrameTest, DepthIsTestedAndCanBeSampledAfterwards) {
    FrameRing ring(device());
    FrameExecutor executor(device());
    OffscreenTarget target(device(), kSize);
    const GraphicsPipeline pipeline(device(), {.name = "behind",
                                               .vertex = {shaders::shaders_triangle_vert},
                                               .fragment = {shaders::shaders_triangle_frag},
                                               .depthTest = true,
                                               .depthWrite = true,
                                               .depthFormat = VK_FORMAT_D32_SFLOAT});
    // The triangle lies at depth 0.5: drawn over a far plane, hidden by a near one.
    for (const float plane : {1.0f, 0.25f}) {
        ring.begin();
        FrameGraph graph;
        const ImageId color = graph.importImage("target", target.image());
        const ImageId depth = graph.addPass(
            "depth",
            [&](PassBuilder& pass) {
                (void)pass.write(color, access::kColorAttachment);
                return pass.create("depth", {kSize, VK_FORMAT_D32_SFLOAT}, access::kDepthAttachment);
            },
            [&pipeline, color, plane](PassContext& context, ImageId depth) {
                const Attachment colors{context.view(color), VK_ATTACHMENT_LOAD_OP_CLEAR};
                const Attachment depths{context.view(depth), VK_ATTACHMENT_LOAD_OP_CLEAR, {.depthStencil = {plane, 0}}};
                beginRendering(context.commands(), context.extent(color), colors, depths);
                pipeline.bind(context.commands());
                vkCmdDraw(context.commands(), 3, 1, 0, 0);
                pipeline.warmUp(context.commands());
                vkCmdEndRenderingKHR(context.commands());
            });
        graph.addPass(
            "reader of depth",
            [&](PassBuilder& pass) {
                pass.read(depth, access::kComputeSample);
                pass.keep();
            },
            [](PassContext&) {});
        executor.run(graph, ring);
        ring.submit();
        const size_t bottomLeft = size_t{kSize.width} * (kSize.height - 1) * 4;
        EXPECT_EQ(target.readRows()[bottomLeft], plane > 0.5f ? std::byte{255} : std::byte{0});
    }
}

TEST_F(FrameTest, AbandonedFrameLeavesNothing) {
    FrameRing ring(device());
    for (int i = 0; i < 5; ++i) {
        ring.begin();
        const uint32_t row = ring.timers().begin(ring.commands(), "never");
        ring.timers().end(ring.commands(), row);
        const Buffer temporary(device(), {.size = 1024});
        if (i % 2)
            ring.submit();
        else
            ring.abandon();
    }
    EXPECT_THROW(ring.submit(), UsageError);
}

} // namespace
} // namespace q3rt
