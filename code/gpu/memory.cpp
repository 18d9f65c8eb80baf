#include "gpu/memory.hpp"

#include <algorithm>
#include <vector>

#include "base/error.hpp"

namespace q3rt {

struct MemoryBlock {
    MemoryBlock(uint32_t memoryType, bool forLinear, VkDeviceSize size)
        : type(memoryType)
        , linear(forLinear)
        , ranges(size) {}
    uint32_t type;
    bool linear;
    RangeAllocator ranges;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    void* mapped = nullptr;
    size_t allocationCount = 0;
};

namespace {

constexpr VkDeviceSize kMiB = VkDeviceSize{1} << 20;
// Blocks double from the first size to the last: a menu takes little, a map takes few driver allocations.
constexpr VkDeviceSize kFirstBlockBytes = 8 * kMiB;
constexpr VkDeviceSize kLastBlockBytes = 256 * kMiB;
// Device-local memory that the CPU can map is worth using for uploads only if it is not the classic 256 MiB window.
constexpr VkDeviceSize kLargeMappableHeapBytes = 1024 * kMiB;

VkMemoryPropertyFlags requiredFlags(MemoryDomain domain) {
    if (domain == MemoryDomain::DeviceLocal) return 0;
    return VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

} // namespace

MemoryAllocator::MemoryAllocator(VkPhysicalDevice physical, VkDevice device, bool deviceAddress)
    : m_device(device)
    , m_deviceAddress(deviceAddress) {
    vkGetPhysicalDeviceMemoryProperties(physical, &m_properties);
}

MemoryAllocator::~MemoryAllocator() {
    for (const auto& block : m_blocks)
        vkFreeMemory(m_device, block->memory, nullptr);
}

std::vector<uint32_t> MemoryAllocator::rankTypes(uint32_t typeBits, MemoryDomain domain) const {
    struct Ranked {
        uint32_t type;
        int score;
    };
    std::vector<Ranked> ranked;
    for (uint32_t type = 0; type < m_properties.memoryTypeCount; ++type) {
        const VkMemoryPropertyFlags flags = m_properties.memoryTypes[type].propertyFlags;
        if (!(typeBits & (1u << type)) || (flags & requiredFlags(domain)) != requiredFlags(domain)) continue;
        // Lazily allocated, protected and device-coherent memory is for other uses.
        if (flags & ~VkMemoryPropertyFlags{0xf}) continue;
        const bool local = flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
        const bool visible = flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
        const bool cached = flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
        const bool large =
            m_properties.memoryHeaps[m_properties.memoryTypes[type].heapIndex].size >= kLargeMappableHeapBytes;
        int score = 0;
        switch (domain) {
        case MemoryDomain::DeviceLocal:
            score = (local ? 4 : 0) + (visible ? 0 : 1);
            break;
        case MemoryDomain::Upload:
            score = (local && large ? 4 : 0) + (local && !large ? 0 : 2) + (cached ? 0 : 1);
            break;
        case MemoryDomain::Readback:
            score = (cached ? 4 : 0) + (local ? 0 : 1);
            break;
        }
        ranked.push_back({type, score});
    }
    // Equal scores keep the driver's order, which is its own preference.
    std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.score > b.score; });
    std::vector<uint32_t> types;
    for (const Ranked& entry : ranked)
        types.push_back(entry.type);
    return types;
}

MemoryBlock* MemoryAllocator::addBlock(uint32_t type, VkDeviceSize size, bool linear, VkResult& result) {
    auto block = std::make_unique<MemoryBlock>(type, linear, size);
    VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.pNext = linear && m_deviceAddress ? &flags : nullptr;
    info.allocationSize = size;
    info.memoryTypeIndex = type;
    result = vkAllocateMemory(m_device, &info, nullptr, &block->memory);
    if (result != VK_SUCCESS) return nullptr;
    if (m_properties.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
        result = vkMapMemory(m_device, block->memory, 0, VK_WHOLE_SIZE, 0, &block->mapped);
        if (result != VK_SUCCESS) {
            vkFreeMemory(m_device, block->memory, nullptr);
            return nullptr;
        }
    }
    m_blocks.push_back(std::move(block));
    return m_blocks.back().get();
}

MemoryBlock* MemoryAllocator::growFor(uint32_t type, VkDeviceSize size, bool linear, VkResult& result) {
    VkDeviceSize blockBytes = kFirstBlockBytes;
    for (const auto& block : m_blocks)
        if (block->type == type && block->linear == linear)
            blockBytes = std::max(blockBytes, std::min(block->ranges.size() * 2, kLastBlockBytes));
    // A resource of more than half a block gets memory of exactly its size.
    if (size > blockBytes / 2) return addBlock(type, size, linear, result);
    MemoryBlock* block = addBlock(type, blockBytes, linear, result);
    // Short of memory: try again with no more than is needed.
    return block ? block : addBlock(type, size, linear, result);
}

Allocation MemoryAllocator::allocate(const VkMemoryRequirements& needs, MemoryDomain domain, bool linear) {
    const auto handOut = [&](MemoryBlock& block, VkDeviceSize offset) {
        ++block.allocationCount;
        const bool map = domain != MemoryDomain::DeviceLocal;
        return Allocation{block.memory, offset, needs.size,
                          map ? static_cast<std::byte*>(block.mapped) + offset : nullptr, &block};
    };
    VkResult result = VK_ERROR_FEATURE_NOT_PRESENT;
    for (const uint32_t type : rankTypes(needs.memoryTypeBits, domain)) {
        for (const auto& block : m_blocks) {
            if (block->type != type || block->linear != linear) continue;
            if (const auto offset = block->ranges.allocate(needs.size, needs.alignment))
                return handOut(*block, *offset);
        }
        MemoryBlock* block = growFor(type, needs.size, linear, result);
        if (block) return handOut(*block, block->ranges.allocate(needs.size, needs.alignment).value());
    }
    const MemoryUse use = measureUse();
    throw DeviceError(formatText(
        "device memory: %.1f MiB more can't be had (%s; %.1f MiB in use): raise r_picmip, lower "
        "the resolution, or close other programs",
        static_cast<double>(needs.size) / kMiB, resultName(result), static_cast<double>(use.reservedBytes) / kMiB));
}

void MemoryAllocator::free(const Allocation& allocation) {
    if (!allocation.block) return;
    MemoryBlock& block = *allocation.block;
    block.ranges.free(allocation.offset, allocation.size);
    --block.allocationCount;
    if (block.allocationCount > 0) return;
    vkFreeMemory(m_device, block.memory, nullptr);
    m_blocks.remove_if([&](const auto& candidate) { return candidate.get() == &block; });
}

MemoryUse MemoryAllocator::measureUse() const {
    MemoryUse use;
    for (const auto& block : m_blocks) {
        use.reservedBytes += block->ranges.size();
        use.usedBytes += block->ranges.used();
        use.allocationCount += block->allocationCount;
        ++use.blockCount;
    }
    return use;
}

} // namespace q3rt
