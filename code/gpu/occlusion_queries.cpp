#include "gpu/occlusion_queries.hpp"

#include <algorithm>

#include "gpu/device.hpp"
#include "gpu/readback.hpp"

namespace q3rt {

namespace {

constexpr uint32_t kFirstCapacity = 64;

void retirePool(Device& device, VkQueryPool pool) {
    if (pool) device.retire([handle = device.handle(), pool] { vkDestroyQueryPool(handle, pool, nullptr); });
}

} // namespace

OcclusionQueries::OcclusionQueries(Device& device, uint32_t framesInFlight)
    : m_device(device)
    , m_slots(framesInFlight) {}

OcclusionQueries::~OcclusionQueries() {
    for (const Slot& slot : m_slots)
        retirePool(m_device, slot.pool);
}

void OcclusionQueries::beginFrame(uint32_t slot, uint64_t frame) {
    m_slot = slot;
    Slot& current = m_slots[slot];
    m_answers = current.answers.mappedAs<uint32_t>().first(current.count);
    m_answeredFrame = current.frame;
    current.frame = frame;
    current.count = 0;
}

void OcclusionQueries::reserve(VkCommandBuffer commands, uint32_t count) {
    Slot& slot = m_slots[m_slot];
    m_answers = {};
    slot.count = count;
    if (count == 0) return;
    if (count > slot.capacity) {
        retirePool(m_device, slot.pool);
        slot.capacity = std::max(count, std::max(slot.capacity * 2, kFirstCapacity));
        VkQueryPoolCreateInfo create{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        create.queryType = VK_QUERY_TYPE_OCCLUSION;
        create.queryCount = slot.capacity;
        slot.pool = VK_NULL_HANDLE;
        vkCheck(vkCreateQueryPool(m_device.handle(), &create, nullptr, &slot.pool), "vkCreateQueryPool");
        slot.answers = Buffer(m_device, {.size = slot.capacity * sizeof(uint32_t),
                                         .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                         .domain = MemoryDomain::Readback,
                                         .name = "occlusion answers"});
    }
    std::ranges::fill(slot.answers.mappedAs<uint32_t>(), kUnanswered);
    vkCmdResetQueryPool(commands, slot.pool, 0, slot.capacity);
}

void OcclusionQueries::begin(VkCommandBuffer commands, uint32_t number) {
    vkCmdBeginQuery(commands, m_slots[m_slot].pool, number, 0);
}

void OcclusionQueries::end(VkCommandBuffer commands, uint32_t number) {
    vkCmdEndQuery(commands, m_slots[m_slot].pool, number);
}

void OcclusionQueries::answer(VkCommandBuffer commands, uint32_t first, uint32_t count) {
    if (count == 0) return;
    const Slot& slot = m_slots[m_slot];
    vkCmdCopyQueryPoolResults(commands, slot.pool, first, count, slot.answers.handle(), first * sizeof(uint32_t),
                              sizeof(uint32_t), VK_QUERY_RESULT_WAIT_BIT);
    recordHostBarrier(commands);
}

} // namespace q3rt
