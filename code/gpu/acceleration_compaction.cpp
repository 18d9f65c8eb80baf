// Compaction of bottom-level structures: ask for the sizes, copy into structures of that size, let the old ones go.

#include "gpu/acceleration_structure.hpp"
#include "gpu/device.hpp"

namespace q3rt {
namespace {

/// The compacted size in bytes of each structure.
std::vector<VkDeviceSize> readCompactedSizes(Device& device, std::span<const VkAccelerationStructureKHR> handles) {
    const auto count = static_cast<uint32_t>(handles.size());
    struct Pool {
        VkDevice device;
        VkQueryPool handle = VK_NULL_HANDLE;
        ~Pool() { vkDestroyQueryPool(device, handle, nullptr); }
    } pool{device.handle()};
    VkQueryPoolCreateInfo create{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    create.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    create.queryCount = count;
    vkCheck(vkCreateQueryPool(device.handle(), &create, nullptr, &pool.handle), "vkCreateQueryPool");
    device.submitAndWait([&](VkCommandBuffer commands) {
        vkCmdResetQueryPool(commands, pool.handle, 0, count);
        recordBuildBarrier(device, commands);
        vkCmdWriteAccelerationStructuresPropertiesKHR(commands, count, handles.data(), create.queryType, pool.handle,
                                                      0);
    });
    std::vector<VkDeviceSize> sizes(count);
    vkCheck(vkGetQueryPoolResults(device.handle(), pool.handle, 0, count, sizes.size() * sizeof(VkDeviceSize),
                                  sizes.data(), sizeof(VkDeviceSize),
                                  VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
            "vkGetQueryPoolResults");
    return sizes;
}

} // namespace

void compactStructures(Device& device, std::span<AccelerationStructure* const> structures) {
    if (structures.empty()) return;
    std::vector<VkAccelerationStructureKHR> handles;
    for (const AccelerationStructure* structure : structures)
        handles.push_back(structure->handle());
    const std::vector<VkDeviceSize> sizes = readCompactedSizes(device, handles);

    std::vector<AccelerationStructure> compacted(structures.size());
    for (size_t i = 0; i < structures.size(); ++i) {
        const AccelerationStructure& original = *structures[i];
        compacted[i].m_device = &device;
        compacted[i].m_info = original.m_info;
        compacted[i].m_buildScratch = original.m_buildScratch;
        compacted[i].m_updateScratch = original.m_updateScratch;
        compacted[i].create(device, original.m_type, sizes[i]);
    }
    device.submitAndWait([&](VkCommandBuffer commands) {
        for (size_t i = 0; i < structures.size(); ++i) {
            VkCopyAccelerationStructureInfoKHR copy{VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR};
            copy.src = structures[i]->handle();
            copy.dst = compacted[i].handle();
            copy.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
            vkCmdCopyAccelerationStructureKHR(commands, &copy);
        }
        recordBuildBarrier(device, commands);
    });
    for (size_t i = 0; i < structures.size(); ++i)
        *structures[i] = std::move(compacted[i]);
}

} // namespace q3rt
