// The compile step of frames, without a GPU: order, culling, barriers, lifetimes, wrong declarations.

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "frame/frame_graph.hpp"

namespace q3rt {
namespace {

const GraphImageInfo kInfo{{640, 480}, VK_FORMAT_R16G16B16A16_SFLOAT};
const ResourceState kSampledBefore{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

void nothing(PassContext&) {}

/// A pass that makes an image.
ImageId addMaker(FrameGraph& graph, const char* pass, const char* image, const Access& how = access::kComputeWrite) {
    ImageId made;
    graph.addPass(
        pass, [&](PassBuilder& builder) { made = builder.create(image, kInfo, how); }, nothing);
    return made;
}

/// A kept pass that reads an image.
void addReader(FrameGraph& graph, const char* pass, ImageId image, const Access& how) {
    graph.addPass(
        pass,
        [&](PassBuilder& builder) {
            builder.read(image, how);
            builder.keep();
        },
        nothing);
}

TEST(FrameGraph, PrintsAWholeFrame) {
    FrameGraph graph;
    const ImageId target = graph.importImage("target", {{640, 480}}, kSampledBefore);
    const ImageId hdr = addMaker(graph, "primary", "hdr", access::kRayWrite);
    ImageId debugView = addMaker(graph, "debug view", "debug");
    graph.addPass(
        "tonemap",
        [&](PassBuilder& pass) {
            pass.read(hdr, access::kComputeSample);
            (void)pass.write(target, access::kComputeWrite);
        },
        nothing);
    graph.compile();
    EXPECT_TRUE(debugView);
    EXPECT_EQ(graph.print(), "0 primary\n"
                             "    hdr: none none undefined -> rays storage-read|storage-write general (new)\n"
                             "1 debug view (dropped)\n"
                             "2 tonemap\n"
                             "    hdr: rays storage-write general -> compute sampled sampled\n"
                             "    target: fragment none sampled -> compute storage-read|storage-write general\n"
                             "target 640x480 format 37 imported: passes 2 to 2\n"
                             "hdr 640x480 format 97: passes 0 to 2\n"
                             "debug 640x480 format 97: unused\n");
}

TEST(FrameGraph, OnlyNeededPassesRun) {
    FrameGraph graph;
    const ImageId a = addMaker(graph, "a", "a");
    ImageId b;
    graph.addPass(
        "b from a",
        [&](PassBuilder& pass) {
            pass.read(a, access::kComputeSample);
            b = pass.create("b", kInfo, access::kComputeWrite);
        },
        nothing);
    addMaker(graph, "c", "c");
    graph.addPass(
        "reader of b, unread itself",
        [&](PassBuilder& pass) {
            pass.read(b, access::kComputeSample);
            (void)pass.create("d", kInfo, access::kComputeWrite);
        },
        nothing);
    graph.compile();
    size_t culled = 0;
    for (const GraphPass& pass : graph.passes())
        culled += pass.culled;
    EXPECT_EQ(culled, 4u) << "nothing leaves this frame";

    FrameGraph kept;
    const ImageId x = addMaker(kept, "x", "x");
    addMaker(kept, "y", "y");
    addReader(kept, "show", x, access::kFragmentSample);
    kept.compile();
    EXPECT_FALSE(kept.passes()[0].culled);
    EXPECT_TRUE(kept.passes()[1].culled);
    EXPECT_FALSE(kept.passes()[2].culled);
}

TEST(FrameGraph, SecondReaderOfTheSameKindNeedsNoBarrier) {
    FrameGraph graph;
    const ImageId image = addMaker(graph, "make", "image");
    addReader(graph, "first", image, access::kComputeSample);
    addReader(graph, "second", image, access::kComputeSample);
    addReader(graph, "other stage", image, access::kFragmentSample);
    graph.compile();
    EXPECT_EQ(graph.passes()[1].barriers.size(), 1u);
    EXPECT_EQ(graph.passes()[2].barriers.size(), 0u);
    // Same layout, but the fragment stage hasn't been waited for: a barrier that chains on the first.
    ASSERT_EQ(graph.passes()[3].barriers.size(), 1u);
    const GraphBarrier& barrier = graph.passes()[3].barriers[0];
    EXPECT_EQ(barrier.from.stages, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    EXPECT_EQ(barrier.from.layout, barrier.to.layout);
    EXPECT_EQ(barrier.to.stages, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
}

TEST(FrameGraph, WriteWaitsForAllReaders) {
    FrameGraph graph;
    BufferId buffer;
    graph.addPass(
        "fill", [&](PassBuilder& pass) { buffer = pass.create("buffer", 64, access::kTransferWrite); }, nothing);
    for (const Access& how : {access::kComputeRead, access::kVertexRead})
        graph.addPass(
            "read",
            [&](PassBuilder& pass) {
                pass.read(buffer, how);
                pass.keep();
            },
            nothing);
    graph.addPass(
        "write",
        [&](PassBuilder& pass) {
            buffer = pass.write(buffer, access::kTransferWrite);
            pass.keep();
        },
        nothing);
    graph.compile();
    ASSERT_EQ(graph.passes()[3].barriers.size(), 1u);
    const VkPipelineStageFlags2 from = graph.passes()[3].barriers[0].from.stages;
    EXPECT_TRUE(from & VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    EXPECT_TRUE(from & VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT);
}

TEST(FrameGraph, WriteAfterWriteIsOrdered) {
    FrameGraph graph;
    ImageId image = addMaker(graph, "opaque", "image", access::kColorAttachment);
    graph.addPass(
        "blended",
        [&](PassBuilder& pass) {
            image = pass.write(image, access::kColorAttachment);
            pass.keep();
        },
        nothing);
    graph.compile();
    ASSERT_EQ(graph.passes()[1].barriers.size(), 1u);
    EXPECT_EQ(graph.passes()[1].barriers[0].from.access, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    EXPECT_EQ(graph.passes()[1].barriers[0].from.layout, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

TEST(FrameGraph, ImportedStateGoesOnWhereItStopped) {
    ResourceState token;
    for (int frame = 0; frame < 3; ++frame) {
        FrameGraph graph;
        BufferId structures = graph.importToken("structures", token);
        graph.addPass(
            "build", [&](PassBuilder& pass) { structures = pass.write(structures, access::kBuildWrite); }, nothing);
        graph.addPass(
            "trace",
            [&](PassBuilder& pass) {
                pass.read(structures, access::kRayTrace);
                pass.keep();
            },
            nothing);
        graph.compile();
        token = graph.resources()[structures.index].final;
        // The first frame starts from nothing; later builds wait for the last frame's traces.
        ASSERT_EQ(graph.passes()[0].barriers.size(), frame ? 1u : 0u);
        if (frame) {
            EXPECT_TRUE(graph.passes()[0].barriers[0].from.stages & VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR);
        }
        ASSERT_EQ(graph.passes()[1].barriers.size(), 1u);
        EXPECT_EQ(graph.passes()[1].barriers[0].from.access, VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR);
    }
}

TEST(FrameGraph, UploadedImageSampledAnywhereNeedsNoBarrier) {
    FrameGraph graph;
    const ImageId image = graph.importImage("texture", kInfo,
                                            {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    addReader(graph, "fragment", image, access::kFragmentSample);
    addReader(graph, "compute", image, access::kComputeSample);
    graph.compile();
    EXPECT_TRUE(graph.passes()[0].barriers.empty());
    EXPECT_TRUE(graph.passes()[1].barriers.empty());
}

TEST(FrameGraph, ReadAndWriteInOnePassIsOneBarrier) {
    FrameGraph graph;
    const ImageId image = graph.importImage("accumulated", kInfo, {});
    graph.addPass(
        "accumulate",
        [&](PassBuilder& pass) {
            pass.read(image, access::kComputeRead);
            (void)pass.write(image, access::kComputeWrite);
        },
        nothing);
    graph.compile();
    EXPECT_EQ(graph.passes()[0].barriers.size(), 1u);
}

TEST(FrameGraph, UsageIsTheUnionOfAccesses) {
    FrameGraph graph;
    const ImageId image = addMaker(graph, "make", "image", access::kColorAttachment);
    addReader(graph, "read", image, access::kComputeSample);
    addReader(graph, "copy", image, access::kTransferRead);
    graph.compile();
    EXPECT_EQ(graph.resources()[image.index].imageUsage,
              VkImageUsageFlags{VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    EXPECT_EQ(graph.resources()[image.index].firstPass, 0u);
    EXPECT_EQ(graph.resources()[image.index].lastPass, 2u);
}

template <typename Declare>
std::string errorOf(FrameGraph& graph, const Declare& declare) {
    try {
        graph.addPass("wrong", declare, nothing);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

TEST(FrameGraph, WrongDeclarationsNamePassAndResource) {
    FrameGraph graph;
    const ImageId image = addMaker(graph, "make", "picture");
    const auto expectNamed = [](const std::string& text, const char* resource) {
        EXPECT_NE(text.find("\"wrong\""), std::string::npos) << text;
        EXPECT_NE(text.find(resource), std::string::npos) << text;
    };
    expectNamed(errorOf(graph, [](PassBuilder& pass) { pass.read(ImageId{}, access::kComputeSample); }), "never made");
    expectNamed(errorOf(graph, [&](PassBuilder& pass) { (void)pass.write(image, access::kComputeSample); }), "picture");
    expectNamed(errorOf(graph, [&](PassBuilder& pass) { pass.read(image, access::kVertexRead); }), "picture");
    expectNamed(errorOf(graph,
                        [&](PassBuilder& pass) {
                            pass.read(image, access::kComputeSample);
                            pass.read(image, access::kComputeRead);
                        }),
                "two layouts");
    graph.addPass(
        "next", [&](PassBuilder& pass) { (void)pass.write(image, access::kComputeWrite); }, nothing);
    expectNamed(errorOf(graph, [&](PassBuilder& pass) { pass.read(image, access::kComputeSample); }), "picture");
}

TEST(FrameGraph, NothingIsAddedToACompiledFrame) {
    FrameGraph graph;
    addMaker(graph, "make", "image");
    graph.compile();
    EXPECT_THROW(addMaker(graph, "late", "other"), UsageError);
}

} // namespace
} // namespace q3rt
