#include "renderer_rt/passes/check.hpp"

#include "renderer_rt/frame_report.hpp"

namespace q3rt {

namespace {

constexpr uint32_t kGroupSize = 64, kWordsPerInvocation = 16;

} // namespace

void checkFinite(FrameGraph& graph, ViewResources& resources, const char* passName, BufferId buffer, ItemLayout item,
                 VkExtent2D extent) {
    if (!resources.check) return;
    const uint32_t counter = resources.check->report.counterOf(passName);
    const uint32_t wordCount = item.words * extent.width * extent.height;
    graph.addPass(
        "check finite",
        [&](PassBuilder& pass) {
            pass.read(buffer, access::kComputeRead);
            resources.report = pass.write(resources.report, access::kComputeWrite);
        },
        [&pictures = resources.check->pictures, report = resources.report, buffer, wordCount, item,
         counter](PassContext& pass) {
            const RtCheckPush push{pass.address(buffer), pass.address(report), wordCount,
                                   item.words,           item.floats,          counter};
            pictures.dispatchGroups(pass.commands(), PictureStage::CheckFinite, push,
                                    wordCount / (kGroupSize * kWordsPerInvocation) + 1);
        });
}

} // namespace q3rt
