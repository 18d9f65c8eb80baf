#include "gpu/gpu_timers.hpp"

#include <utility>

#include "gpu/device.hpp"

namespace q3rt {
namespace {

constexpr uint32_t kRowsPerPool = 64; // two timestamps a row; pools are added as rows need them

} // namespace

GpuTimers::GpuTimers(Device& device, uint32_t framesInFlight)
    : m_device(device)
    , m_slots(framesInFlight) {}

GpuTimers::~GpuTimers() {
    for (Slot& slot : m_slots)
        m_device.retire([device = m_device.handle(), pools = std::move(slot.pools)] {
            for (const VkQueryPool pool : pools)
                vkDestroyQueryPool(device, pool, nullptr);
        });
}

void GpuTimers::beginFrame(VkCommandBuffer commands, uint32_t slot, uint64_t frame) {
    m_slot = slot;
    Slot& current = m_slots[slot];
    collect(current);
    current.frame = frame;
    for (const VkQueryPool pool : current.pools)
        vkCmdResetQueryPool(commands, pool, 0, kRowsPerPool * 2);
}

void GpuTimers::collectFrame(uint64_t frame) {
    for (Slot& slot : m_slots)
        if (slot.frame == frame) collect(slot);
}

void GpuTimers::collect(Slot& slot) {
    const Capabilities& can = m_device.capabilities();
    std::vector<std::string> names = std::exchange(slot.names, {});
    if (names.empty()) return;
    m_results.clear();
    m_resultsFrame = slot.frame;
    const uint64_t mask = can.timestampBits >= 64 ? ~uint64_t{0} : (uint64_t{1} << can.timestampBits) - 1;
    for (size_t row = 0; row < names.size(); ++row) {
        struct Stamp {
            uint64_t ticks;
            uint64_t available;
        } stamps[2]{};
        const VkResult result = vkGetQueryPoolResults(
            m_device.handle(), slot.pools[row / kRowsPerPool], static_cast<uint32_t>(row % kRowsPerPool) * 2, 2,
            sizeof(stamps), stamps, sizeof(Stamp), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
        // VK_NOT_READY: the frame was abandoned, or a row never ended; it has no time to tell.
        if (result != VK_NOT_READY) vkCheck(result, "vkGetQueryPoolResults");
        if (!stamps[0].available || !stamps[1].available) continue;
        const uint64_t ticks = (stamps[1].ticks - stamps[0].ticks) & mask;
        constexpr double kNsToMs = 1e-6;
        m_results.push_back({std::move(names[row]), static_cast<double>(ticks) * can.timestampPeriodNs * kNsToMs});
    }
}

void GpuTimers::ensurePool(VkCommandBuffer commands, Slot& slot, size_t pool) {
    while (slot.pools.size() <= pool) {
        VkQueryPoolCreateInfo create{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        create.queryType = VK_QUERY_TYPE_TIMESTAMP;
        create.queryCount = kRowsPerPool * 2;
        VkQueryPool made = VK_NULL_HANDLE;
        vkCheck(vkCreateQueryPool(m_device.handle(), &create, nullptr, &made), "vkCreateQueryPool");
        slot.pools.push_back(made);
        vkCmdResetQueryPool(commands, made, 0, kRowsPerPool * 2);
    }
}

uint32_t GpuTimers::begin(VkCommandBuffer commands, std::string_view name) {
    Slot& slot = m_slots[m_slot];
    const Capabilities& can = m_device.capabilities();
    const auto row = static_cast<uint32_t>(slot.names.size());
    if (!enabled || can.timestampBits == 0 || can.timestampPeriodNs == 0) return row;
    ensurePool(commands, slot, row / kRowsPerPool);
    slot.names.emplace_back(name);
    vkCmdWriteTimestamp2KHR(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot.pools[row / kRowsPerPool],
                            row % kRowsPerPool * 2);
    return row;
}

void GpuTimers::end(VkCommandBuffer commands, uint32_t row) {
    Slot& slot = m_slots[m_slot];
    if (row >= slot.names.size()) return;
    vkCmdWriteTimestamp2KHR(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot.pools[row / kRowsPerPool],
                            row % kRowsPerPool * 2 + 1);
}

} // namespace q3rt
