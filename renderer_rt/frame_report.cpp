#include "renderer_rt/frame_report.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "base/error.hpp"
#include "frame/frame_executor.hpp"
#include "gpu/device.hpp"

namespace q3rt {

namespace {

ReportNumbers readNumbers(const RtReport& report, const std::vector<std::string>& passes) {
    ReportNumbers out;
    const auto meanOf = [&](uint32_t sum) {
        const double steps = report.high[sum] * 4294967296.0 + report.low[sum];
        return steps * static_cast<double>(kReportStep) / report.tileCount;
    };
    out.hasError = report.tileCount > 0;
    if (out.hasError) {
        out.likeness = meanOf(kReportLikeness);
        out.error = meanOf(kReportError);
    }
    for (size_t i = 0; i < passes.size(); ++i)
        out.counts.push_back({passes[i], report.nonFinite[i]});
    std::copy(std::begin(report.work), std::end(report.work), out.work.begin());
    out.rayCount = std::accumulate(std::begin(report.rays), std::end(report.rays), uint64_t{0});
    return out;
}

} // namespace

FrameReport::FrameReport(Device& device, uint32_t framesInFlight)
    : m_counted(device, {.size = sizeof(RtReport),
                         .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                         .name = "report"}) {
    for (uint32_t i = 0; i < framesInFlight; ++i)
        m_slots.push_back({Buffer(device, {.size = sizeof(RtReport),
                                           .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                           .domain = MemoryDomain::Readback,
                                           .name = "report copy"}),
                           {},
                           false});
}

void FrameReport::beginFrame(uint32_t slot) {
    m_slot = slot;
    Slot& at = m_slots[slot];
    if (at.filled) {
        RtReport report;
        std::memcpy(&report, at.copy.mapped(), sizeof(report));
        m_latest = readNumbers(report, at.passes);
    }
    at.passes.clear();
    at.filled = false;
}

uint32_t FrameReport::counterOf(const std::string& pass) {
    std::vector<std::string>& passes = m_slots[m_slot].passes;
    const auto found = std::find(passes.begin(), passes.end(), pass);
    if (found != passes.end()) return static_cast<uint32_t>(found - passes.begin());
    if (passes.size() == kReportCounterCount)
        throw UsageError(pass + ": no counter is left for this pass; raise kReportCounterCount");
    passes.push_back(pass);
    return static_cast<uint32_t>(passes.size() - 1);
}

BufferId FrameReport::addClear(FrameGraph& graph) {
    const BufferId report = graph.importBuffer("report", m_counted);
    return graph.addPass(
        "report clear", [&](PassBuilder& pass) { return pass.write(report, access::kTransferWrite); },
        [](PassContext& pass, BufferId cleared) {
            vkCmdFillBuffer(pass.commands(), pass.buffer(cleared), 0, VK_WHOLE_SIZE, 0);
        });
}

void FrameReport::addCopy(FrameGraph& graph, BufferId report) {
    Slot& slot = m_slots[m_slot];
    slot.filled = true;
    graph.addPass(
        "report",
        [&](PassBuilder& pass) {
            pass.read(report, access::kTransferRead);
            pass.keep();
        },
        [report, to = slot.copy.handle()](PassContext& pass) {
            const VkBufferCopy region{0, 0, sizeof(RtReport)};
            vkCmdCopyBuffer(pass.commands(), pass.buffer(report), to, 1, &region);
            const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                           .srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                           .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                           .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                           .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
            const VkDependencyInfo dependency{
                .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &barrier};
            vkCmdPipelineBarrier2KHR(pass.commands(), &dependency);
        });
}

} // namespace q3rt
