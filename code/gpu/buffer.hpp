#pragma once
// A buffer with its memory.

#include <span>
#include <string>

#include "gpu/memory.hpp"

namespace q3rt {

class Device;

struct BufferInfo {
    VkDeviceSize size = 0; // bytes; 0 is made 4, so that every buffer can be bound
    /// Transfer source and destination are always added.
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    MemoryDomain domain = MemoryDomain::DeviceLocal;
    std::string name = "buffer";
};

class Buffer {
  public:
    Buffer() = default;
    Buffer(Device& device, const BufferInfo& info);
    ~Buffer() { release(); }
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept;

    explicit operator bool() const { return m_handle != VK_NULL_HANDLE; }
    VkBuffer handle() const { return m_handle; }
    VkDeviceSize size() const { return m_size; }
    /// Needs VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT in the usage; else 0.
    VkDeviceAddress address() const { return m_address; }
    /// Upload and Readback only; else null. Memory is coherent: nothing to flush.
    std::byte* mapped() const { return static_cast<std::byte*>(m_allocation.mapped); }
    template <typename T>
    std::span<T> mappedAs() const {
        return {reinterpret_cast<T*>(m_allocation.mapped), static_cast<size_t>(m_size / sizeof(T))};
    }

    /// Kept by the frame graph between frames.
    ResourceState state;

  private:
    void release();
    Device* m_device = nullptr;
    VkBuffer m_handle = VK_NULL_HANDLE;
    VkDeviceSize m_size = 0;
    VkDeviceAddress m_address = 0;
    Allocation m_allocation;
};

} // namespace q3rt
