#include "gpu/vulkan_api.hpp"

#include <string_view>

#include "base/error.hpp"

namespace q3rt {

const char* resultName(VkResult result) {
    switch (result) {
#define NAME(code)                                                                                                     \
    case code:                                                                                                         \
        return #code
        NAME(VK_SUCCESS);
        NAME(VK_NOT_READY);
        NAME(VK_TIMEOUT);
        NAME(VK_INCOMPLETE);
        NAME(VK_SUBOPTIMAL_KHR);
        NAME(VK_ERROR_OUT_OF_HOST_MEMORY);
        NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY);
        NAME(VK_ERROR_INITIALIZATION_FAILED);
        NAME(VK_ERROR_DEVICE_LOST);
        NAME(VK_ERROR_MEMORY_MAP_FAILED);
        NAME(VK_ERROR_LAYER_NOT_PRESENT);
        NAME(VK_ERROR_EXTENSION_NOT_PRESENT);
        NAME(VK_ERROR_FEATURE_NOT_PRESENT);
        NAME(VK_ERROR_INCOMPATIBLE_DRIVER);
        NAME(VK_ERROR_TOO_MANY_OBJECTS);
        NAME(VK_ERROR_FORMAT_NOT_SUPPORTED);
        NAME(VK_ERROR_FRAGMENTED_POOL);
        NAME(VK_ERROR_OUT_OF_POOL_MEMORY);
        NAME(VK_ERROR_SURFACE_LOST_KHR);
        NAME(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR);
        NAME(VK_ERROR_OUT_OF_DATE_KHR);
        NAME(VK_ERROR_INVALID_SHADER_NV);
        NAME(VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS);
        NAME(VK_ERROR_FRAGMENTATION);
        NAME(VK_ERROR_UNKNOWN);
#undef NAME
    default:
        return "an unlisted VkResult";
    }
}

void vkCheck(VkResult result, const char* call, std::source_location place) {
    if (result == VK_SUCCESS) return;
    const std::string_view path = place.file_name();
    const std::string_view file = path.substr(path.rfind('/') + 1);
    throw DeviceError(formatText("%s returned %s (%d) at %.*s:%u", call, resultName(result), static_cast<int>(result),
                                 static_cast<int>(file.size()), file.data(), static_cast<unsigned>(place.line())));
}

} // namespace q3rt
