#pragma once
// What a physical device can do, in a form that can be printed, compared and decided upon.

#include <string>
#include <vector>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

struct Capabilities {
    std::string deviceName;
    std::string driverName;
    std::string driverInfo;
    uint32_t apiVersion = 0;
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    bool software = false; // a CPU draws (lavapipe)

    bool accelerationStructure = false;
    bool rayTracingPipeline = false;
    bool rayQuery = false;
    bool dynamicRendering = false;
    bool synchronization2 = false;
    bool extendedDynamicState = false;  // cull mode, depth test, topology ... set while recording
    bool extendedDynamicState2 = false; // depth bias enable, primitive restart
    bool dynamicBlendEnable = false;    // extended dynamic state 3, each by itself
    bool dynamicBlendEquation = false;
    bool dynamicWriteMask = false;
    bool dynamicPolygonMode = false;
    bool scalarBlockLayout = false;
    bool descriptorIndexing = false; // all that BindlessTextures needs
    bool bufferDeviceAddress = false;
    bool samplerAnisotropy = false;
    bool fillModeNonSolid = false; // r_showtris
    bool depthClamp = false;
    bool depthBiasClamp = false;
    bool shaderFloat64 = false;
    bool shaderInt64 = false;
    bool multiview = false;
    bool swapchain = false;

    float timestampPeriodNs = 0; // nanoseconds a tick; 0: no timestamps on the queue
    uint32_t timestampBits = 0;
    uint32_t subgroupSize = 0;
    uint32_t maxBindlessTextures = 0;
    VkPhysicalDeviceLimits limits{};
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR rayTracing{};
    VkPhysicalDeviceAccelerationStructurePropertiesKHR acceleration{};

    /// What q3rt can't run without and this device lacks, in words; empty if it will do.
    std::vector<std::string> missing;

    bool usable() const { return missing.empty(); }
    /// Can any ray-tracing back end but our own compute one run?
    bool hardwareTracing() const { return accelerationStructure && (rayTracingPipeline || rayQuery); }
};

/// Reads all of it. `needsPresentation` adds the swapchain to what must be there.
Capabilities readCapabilities(VkPhysicalDevice device, bool needsPresentation);

/// One line for a log or `q3rt doctor`: name, driver, ray-tracing parts, what is missing.
std::string describeCapabilities(const Capabilities& capabilities);

} // namespace q3rt
