#pragma once
// Creating the Vulkan instance, with its failures put into words. Private to gpu/.

#include <memory>
#include <string>
#include <vector>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

struct InstanceInfo {
    bool validation = false;
    std::vector<std::string> extensions;
    std::vector<std::string>* messages = nullptr; // where validation messages go; must outlive the instance
};

struct Instance {
    VkInstance handle = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE; // with validation
    bool debugUtils = false;
};

/// Throws DeviceError naming the remedy when there is no loader, no driver or no validation layer.
Instance createInstance(const InstanceInfo& info);
void destroyInstance(Instance& instance);
std::vector<VkPhysicalDevice> listPhysicalDevices(VkInstance instance);

} // namespace q3rt
