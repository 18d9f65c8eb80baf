#include "gpu/growing_buffer.hpp"

#include <algorithm>

#include "gpu/device.hpp"

namespace q3rt {

GrowingBuffer::GrowingBuffer(Device& device, BufferInfo info, uint32_t framesInFlight)
    : m_device(&device)
    , m_info(std::move(info)) {
    for (uint32_t i = 0; i < framesInFlight; ++i)
        m_buffers.emplace_back(device, m_info);
}

void GrowingBuffer::beginFrame(uint32_t slot) {
    m_slot = slot;
    m_used = 0;
}

void GrowingBuffer::require(VkDeviceSize size) {
    const VkDeviceSize capacity = m_buffers[m_slot].size();
    if (m_used <= capacity && size <= capacity - m_used) return;
    // The full buffer is retired with this frame, whose earlier slices still lie in it.
    BufferInfo larger = m_info;
    larger.size = std::max(capacity * 2, size);
    m_buffers[m_slot] = Buffer(*m_device, larger);
    m_used = 0;
}

BufferSlice GrowingBuffer::reserve(VkDeviceSize size, VkDeviceSize alignment) {
    m_used = (m_used + alignment - 1) & ~(alignment - 1);
    require(size);
    const Buffer& buffer = m_buffers[m_slot];
    const BufferSlice slice{buffer.handle(), m_used, size, buffer.address() ? buffer.address() + m_used : 0,
                            buffer.mapped() + m_used};
    m_used += size;
    return slice;
}

} // namespace q3rt
