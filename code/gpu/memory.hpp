#pragma once
// Device memory in large blocks, cut up by RangeAllocator. Grows block by block; empty blocks go back to the driver.

#include <list>
#include <memory>
#include <vector>

#include "gpu/range_allocator.hpp"
#include "gpu/vulkan_api.hpp"

namespace q3rt {

enum class MemoryDomain {
    DeviceLocal, // fastest for the GPU, not mapped
    Upload,      // mapped, coherent, written by the CPU front to back
    Readback,    // mapped, coherent, cached where the device has it
};

struct MemoryBlock;

struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    VkDeviceSize size = 0;
    void* mapped = nullptr; // first byte of this allocation; null for DeviceLocal
    MemoryBlock* block = nullptr;
};

struct MemoryUse {
    VkDeviceSize reservedBytes = 0; // taken from the driver
    VkDeviceSize usedBytes = 0;     // handed out
    size_t blockCount = 0;
    size_t allocationCount = 0;
};

class MemoryAllocator {
  public:
    /// `deviceAddress`: blocks of buffers allow vkGetBufferDeviceAddress.
    MemoryAllocator(VkPhysicalDevice physical, VkDevice device, bool deviceAddress);
    ~MemoryAllocator();
    MemoryAllocator(const MemoryAllocator&) = delete;
    MemoryAllocator& operator=(const MemoryAllocator&) = delete;

    /// Linear resources (buffers) and optimally tiled images never share a block: no granularity rule to keep.
    Allocation allocate(const VkMemoryRequirements& needs, MemoryDomain domain, bool linear);
    void free(const Allocation& allocation);
    MemoryUse measureUse() const;

  private:
    /// Memory types that will do, best first.
    std::vector<uint32_t> rankTypes(uint32_t typeBits, MemoryDomain domain) const;
    MemoryBlock* addBlock(uint32_t type, VkDeviceSize size, bool linear, VkResult& result);
    MemoryBlock* growFor(uint32_t type, VkDeviceSize size, bool linear, VkResult& result);

    VkDevice m_device;
    bool m_deviceAddress;
    VkPhysicalDeviceMemoryProperties m_properties{};
    std::list<std::unique_ptr<MemoryBlock>> m_blocks;
};

} // namespace q3rt
