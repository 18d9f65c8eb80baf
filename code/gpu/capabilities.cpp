#include "gpu/capabilities.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "gpu/device_features.hpp"

namespace q3rt {
namespace {

void readProperties(VkPhysicalDevice device, Capabilities& can) {
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceDescriptorIndexingProperties indexing{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_PROPERTIES};
    can.rayTracing.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR;
    can.acceleration.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
    properties.pNext = &driver;
    driver.pNext = &subgroup;
    subgroup.pNext = &indexing;
    void** tail = &indexing.pNext;
    if (can.rayTracingPipeline) {
        *tail = &can.rayTracing;
        tail = &can.rayTracing.pNext;
    }
    if (can.accelerationStructure) *tail = &can.acceleration;
    vkGetPhysicalDeviceProperties2(device, &properties);
    can.rayTracing.pNext = nullptr;
    can.acceleration.pNext = nullptr;

    can.deviceName = properties.properties.deviceName;
    can.driverName = driver.driverName;
    can.driverInfo = driver.driverInfo;
    can.apiVersion = properties.properties.apiVersion;
    can.type = properties.properties.deviceType;
    can.software = can.type == VK_PHYSICAL_DEVICE_TYPE_CPU;
    can.limits = properties.properties.limits;
    can.timestampPeriodNs = can.limits.timestampPeriod;
    can.subgroupSize = subgroup.subgroupSize;
    can.maxBindlessTextures = std::min({indexing.maxPerStageDescriptorUpdateAfterBindSamplers,
                                        indexing.maxPerStageDescriptorUpdateAfterBindSampledImages,
                                        indexing.maxDescriptorSetUpdateAfterBindSamplers,
                                        indexing.maxDescriptorSetUpdateAfterBindSampledImages});
}

void readFeatures(const DeviceFeatures& has, Capabilities& can) {
    const VkPhysicalDeviceFeatures& core = has.core.features;
    can.accelerationStructure = has.acceleration.accelerationStructure;
    can.rayTracingPipeline = can.accelerationStructure && has.rayTracing.rayTracingPipeline;
    can.rayQuery = can.accelerationStructure && has.rayQuery.rayQuery;
    can.dynamicRendering = has.dynamicRendering.dynamicRendering;
    can.synchronization2 = has.synchronization2.synchronization2;
    can.extendedDynamicState = has.dynamicState.extendedDynamicState;
    can.extendedDynamicState2 = has.dynamicState2.extendedDynamicState2;
    can.dynamicBlendEnable = has.dynamicState3.extendedDynamicState3ColorBlendEnable;
    can.dynamicBlendEquation = has.dynamicState3.extendedDynamicState3ColorBlendEquation;
    can.dynamicWriteMask = has.dynamicState3.extendedDynamicState3ColorWriteMask;
    can.dynamicPolygonMode = has.dynamicState3.extendedDynamicState3PolygonMode;
    can.scalarBlockLayout = has.v12.scalarBlockLayout;
    can.descriptorIndexing =
        has.v12.descriptorIndexing && has.v12.runtimeDescriptorArray && has.v12.descriptorBindingPartiallyBound &&
        has.v12.descriptorBindingVariableDescriptorCount && has.v12.descriptorBindingSampledImageUpdateAfterBind &&
        has.v12.descriptorBindingUpdateUnusedWhilePending && has.v12.shaderSampledImageArrayNonUniformIndexing;
    can.bufferDeviceAddress = has.v12.bufferDeviceAddress;
    can.samplerAnisotropy = core.samplerAnisotropy;
    can.fillModeNonSolid = core.fillModeNonSolid;
    can.depthClamp = core.depthClamp;
    can.depthBiasClamp = core.depthBiasClamp;
    can.shaderFloat64 = core.shaderFloat64;
    can.shaderInt64 = core.shaderInt64;
    can.multiview = has.v11.multiview;
    can.swapchain = has.has(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
}

void listMissing(Capabilities& can, bool needsPresentation) {
    const auto need = [&](bool present, const char* what) {
        if (!present) can.missing.emplace_back(what);
    };
    need(can.apiVersion >= VK_API_VERSION_1_2, "Vulkan 1.2");
    need(can.dynamicRendering, "dynamic rendering (VK_KHR_dynamic_rendering)");
    need(can.synchronization2, "VK_KHR_synchronization2");
    need(can.scalarBlockLayout, "scalar block layout");
    need(can.descriptorIndexing, "descriptor indexing (bindless textures)");
    need(can.bufferDeviceAddress, "buffer device addresses");
    if (needsPresentation) need(can.swapchain, "presentation to a window (VK_KHR_swapchain)");
}

} // namespace

Capabilities readCapabilities(VkPhysicalDevice device, bool needsPresentation) {
    Capabilities can;
    VkPhysicalDeviceProperties basic;
    vkGetPhysicalDeviceProperties(device, &basic);
    // The 1.2 structures may not be passed to an older device; its name and version are all that is said of it.
    if (basic.apiVersion < VK_API_VERSION_1_2) {
        can.deviceName = basic.deviceName;
        can.apiVersion = basic.apiVersion;
        can.type = basic.deviceType;
        can.software = can.type == VK_PHYSICAL_DEVICE_TYPE_CPU;
        can.limits = basic.limits;
        can.missing.emplace_back("Vulkan 1.2");
        return can;
    }
    readFeatures(DeviceFeatures(device), can);
    readProperties(device, can);
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (const VkQueueFamilyProperties& family : families) {
        if (!(family.queueFlags & VK_QUEUE_GRAPHICS_BIT)) continue;
        can.timestampBits = family.timestampValidBits;
        break;
    }
    listMissing(can, needsPresentation);
    return can;
}

std::string describeCapabilities(const Capabilities& can) {
    std::string text = formatText("%s (%s %s, Vulkan %u.%u.%u)", can.deviceName.c_str(), can.driverName.c_str(),
                                  can.driverInfo.c_str(), VK_API_VERSION_MAJOR(can.apiVersion),
                                  VK_API_VERSION_MINOR(can.apiVersion), VK_API_VERSION_PATCH(can.apiVersion));
    if (can.software) text += ", software";
    text += ", ray tracing:";
    if (can.rayTracingPipeline) text += " pipeline";
    if (can.rayQuery) text += " query";
    text += can.usable() ? " compute" : " none";
    if (!can.usable()) {
        text += "; can't be used, it lacks ";
        for (size_t i = 0; i < can.missing.size(); ++i)
            text += (i ? ", " : "") + can.missing[i];
    }
    return text;
}

} // namespace q3rt
