#include "gpu/occlusion_queries.hpp"

#include <algorithm>

#include "gpu/device.hpp"

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
    m_answers.clear();
    m_answeredFrame = current.frame;
    current.frame = frame;
    if (current.count == 0) return;
    m_results.resize(current.count);
    const VkResult result =
        vkGetQueryPoolResults(m_device.handle(), current.pool, 0, current.count, current.count * sizeof(uint32_t),
                              m_results.data(), sizeof(uint32_t), 0);
    current.count = 0;
    if (result == VK_NOT_READY) return; // not all of them were drawn
    vkCheck(result, "vkGetQueryPoolResults");
    for (const uint32_t passed : m_results)
        m_answers.push_back(passed != 0 ? 1 : 0);
}

void OcclusionQueries::reserve(VkCommandBuffer commands, uint32_t count) {
    Slot& slot = m_slots[m_slot];
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
    }
    vkCmdResetQueryPool(commands, slot.pool, 0, slot.capacity);
}

void OcclusionQueries::begin(VkCommandBuffer commands, uint32_t number) {
    vkCmdBeginQuery(commands, m_slots[m_slot].pool, number, 0);
}

void OcclusionQueries::end(VkCommandBuffer commands, uint32_t number) {
    vkCmdEndQuery(commands, m_slots[m_slot].pool, number);
}

} // namespace q3rt
