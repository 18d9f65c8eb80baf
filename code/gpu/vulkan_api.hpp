#pragma once
// Vulkan entry points (volk) and the one check every call goes through, in release builds too.

#include <source_location>

#include <volk.h>

namespace q3rt {

/// "VK_ERROR_DEVICE_LOST" and the like; the number's meaning in Vulkan's own spelling.
const char* resultName(VkResult result);

/// Throws DeviceError naming the call, the result and the place, unless `result` is VK_SUCCESS.
/// Calls with more than one good answer (swapchains, queries) test the result themselves.
void vkCheck(VkResult result, const char* call, std::source_location place = std::source_location::current());

/// What last touched a buffer or image: the source half of the next barrier. Spelled in raw Vulkan names.
struct ResourceState {
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 access = VK_ACCESS_2_NONE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED; // images only
};

} // namespace q3rt
