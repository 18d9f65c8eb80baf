#include "gpu/device_features.hpp"

#include <algorithm>

namespace q3rt {
namespace {

constexpr const char* kKnownExtensions[] = {
    VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME,
    VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME,
    VK_EXT_EXTENDED_DYNAMIC_STATE_EXTENSION_NAME,
    VK_EXT_EXTENDED_DYNAMIC_STATE_2_EXTENSION_NAME,
    VK_EXT_EXTENDED_DYNAMIC_STATE_3_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
    VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
    VK_KHR_RAY_QUERY_EXTENSION_NAME,
};

} // namespace

DeviceFeatures::DeviceFeatures(VkPhysicalDevice device) {
    uint32_t count = 0;
    vkCheck(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr),
            "vkEnumerateDeviceExtensionProperties");
    std::vector<VkExtensionProperties> properties(count);
    vkCheck(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, properties.data()),
            "vkEnumerateDeviceExtensionProperties");
    for (const VkExtensionProperties& extension : properties)
        m_present.emplace_back(extension.extensionName);

    core.pNext = &v11;
    v11.pNext = &v12;
    void** tail = &v12.pNext;
    const auto link = [&](const char* extension, auto& features) {
        if (!has(extension)) return;
        *tail = &features;
        tail = &features.pNext;
    };
    link(VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME, dynamicRendering);
    link(VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME, synchronization2);
    link(VK_EXT_EXTENDED_DYNAMIC_STATE_EXTENSION_NAME, dynamicState);
    link(VK_EXT_EXTENDED_DYNAMIC_STATE_2_EXTENSION_NAME, dynamicState2);
    link(VK_EXT_EXTENDED_DYNAMIC_STATE_3_EXTENSION_NAME, dynamicState3);
    link(VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME, acceleration);
    link(VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME, rayTracing);
    link(VK_KHR_RAY_QUERY_EXTENSION_NAME, rayQuery);
    vkGetPhysicalDeviceFeatures2(device, &core);
}

void DeviceFeatures::keepWanted() {
    // Bounds checks of every buffer access cost time; shaders here check what they index.
    core.features.robustBufferAccess = VK_FALSE;
    core.features.sparseBinding = VK_FALSE;
    v11.protectedMemory = VK_FALSE;
    v12.bufferDeviceAddressCaptureReplay = VK_FALSE;
    v12.bufferDeviceAddressMultiDevice = VK_FALSE;
    acceleration.accelerationStructureCaptureReplay = VK_FALSE;
    acceleration.accelerationStructureHostCommands = VK_FALSE;
    rayTracing.rayTracingPipelineShaderGroupHandleCaptureReplay = VK_FALSE;
    rayTracing.rayTracingPipelineShaderGroupHandleCaptureReplayMixed = VK_FALSE;
}

bool DeviceFeatures::has(const char* extension) const {
    return std::find(m_present.begin(), m_present.end(), extension) != m_present.end();
}

std::vector<const char*> DeviceFeatures::extensions(bool presentation) const {
    std::vector<const char*> names;
    for (const char* name : kKnownExtensions)
        if (has(name)) names.push_back(name);
    if (presentation && has(VK_KHR_SWAPCHAIN_EXTENSION_NAME)) names.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    return names;
}

} // namespace q3rt
