#include "gpu/buffer.hpp"

#include <algorithm>
#include <utility>

#include "gpu/device.hpp"

namespace q3rt {

Buffer::Buffer(Device& device, const BufferInfo& info)
    : m_device(&device)
    , m_size(std::max<VkDeviceSize>(info.size, 4)) {
    VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    create.size = m_size;
    create.usage = info.usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    vkCheck(vkCreateBuffer(device.handle(), &create, nullptr, &m_handle), "vkCreateBuffer");
    try {
        VkMemoryRequirements needs;
        vkGetBufferMemoryRequirements(device.handle(), m_handle, &needs);
        m_allocation = device.memory().allocate(needs, info.domain, true);
        vkCheck(vkBindBufferMemory(device.handle(), m_handle, m_allocation.memory, m_allocation.offset),
                "vkBindBufferMemory");
    } catch (...) {
        release();
        throw;
    }
    device.setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(m_handle), info.name);
    if (info.usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) {
        VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
        address.buffer = m_handle;
        m_address = vkGetBufferDeviceAddress(device.handle(), &address);
    }
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this == &other) return *this;
    release();
    m_device = std::exchange(other.m_device, nullptr);
    m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
    m_size = std::exchange(other.m_size, 0);
    m_address = std::exchange(other.m_address, 0);
    m_allocation = std::exchange(other.m_allocation, {});
    state = std::exchange(other.state, {});
    return *this;
}

void Buffer::release() {
    if (!m_handle) return;
    m_device->retire([device = m_device, handle = m_handle, allocation = m_allocation] {
        vkDestroyBuffer(device->handle(), handle, nullptr);
        device->memory().free(allocation);
    });
    m_handle = VK_NULL_HANDLE;
    m_allocation = {};
}

} // namespace q3rt
