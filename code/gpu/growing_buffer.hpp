#pragma once
// Mapped memory for one frame's vertices, indices, uniforms, instances. One per frame in flight; grows by doubling,
// never shrinks. A slice stays valid for its frame even if the buffer grows after it.

#include <cstring>
#include <span>
#include <vector>

#include "gpu/buffer.hpp"

namespace q3rt {

/// Part of a mapped buffer.
struct BufferSlice {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize offset = 0; // bytes from the start of `buffer`
    VkDeviceSize size = 0;
    VkDeviceAddress address = 0; // of the slice; 0 without device-address usage
    std::byte* mapped = nullptr; // first byte of the slice
};

class GrowingBuffer {
  public:
    GrowingBuffer(Device& device, BufferInfo info, uint32_t framesInFlight = 2);

    /// Starts the frame in `slot` (FrameRing::slot()): everything in it is free again.
    void beginFrame(uint32_t slot);
    /// Room for `size` bytes, aligned (power of two, bytes).
    BufferSlice reserve(VkDeviceSize size, VkDeviceSize alignment = 16);
    template <typename T>
    BufferSlice append(std::span<const T> items, VkDeviceSize alignment = 16) {
        const BufferSlice slice = reserve(items.size_bytes(), alignment);
        if (!items.empty()) std::memcpy(slice.mapped, items.data(), items.size_bytes());
        return slice;
    }
    template <typename T>
    BufferSlice append(const T& item, VkDeviceSize alignment = 16) {
        return append(std::span<const T>(&item, 1), alignment);
    }
    /// Makes sure that the next `size` bytes come from one buffer.
    void require(VkDeviceSize size);
    VkBuffer handle() const { return m_buffers[m_slot].handle(); }
    VkDeviceSize capacity() const { return m_buffers[m_slot].size(); }

  private:
    Device* m_device;
    BufferInfo m_info;
    std::vector<Buffer> m_buffers;
    uint32_t m_slot = 0;
    VkDeviceSize m_used = 0;
};

} // namespace q3rt
