#include "gpu/instance.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "base/error.hpp"
#include "base/log.hpp"
#include "gpu/software_driver.hpp"

namespace q3rt {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kNoDriverRemedy =
    "run ./run --set-up, which fetches a software driver, or install your GPU vendor's (Debian: mesa-vulkan-drivers)";

VkBool32 VKAPI_PTR onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                             const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    const std::string text = data->pMessage ? data->pMessage : "(no text)";
    static_cast<std::vector<std::string>*>(user)->push_back(text);
    logLineOnce(LogLevel::Error, "Vulkan validation: %s", text.c_str()); // who asked for it sees all of them
    return VK_FALSE;
}

bool hasExtension(const char* layer, const char* name) {
    uint32_t count = 0;
    if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS) return false;
    std::vector<VkExtensionProperties> list(count);
    if (vkEnumerateInstanceExtensionProperties(layer, &count, list.data()) < 0) return false;
    return std::any_of(list.begin(), list.end(), [&](const auto& e) { return !std::strcmp(e.extensionName, name); });
}

bool hasLayer(const char* name) {
    uint32_t count = 0;
    vkCheck(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
    std::vector<VkLayerProperties> list(count);
    vkCheck(vkEnumerateInstanceLayerProperties(&count, list.data()), "vkEnumerateInstanceLayerProperties");
    return std::any_of(list.begin(), list.end(), [&](const auto& l) { return !std::strcmp(l.layerName, name); });
}

[[noreturn]] void failWithoutDriver(const char* what) {
    if (const char* variable = variableNamingDrivers())
        throw DeviceError(formatText("%s: the environment names drivers by %s=%s; correct or unset it", what, variable,
                                     std::getenv(variable)));
    throw DeviceError(formatText("%s: %s", what, kNoDriverRemedy));
}

void checkResult(VkResult result) {
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) failWithoutDriver("no Vulkan driver was found");
    if (result == VK_ERROR_EXTENSION_NOT_PRESENT)
        throw DeviceError("the Vulkan driver can't draw into this window system's windows: run headless, or install "
                          "a driver that can");
    vkCheck(result, "vkCreateInstance");
}

} // namespace

Instance createInstance(const InstanceInfo& info) {
    offerFetchedDriver();
    if (volkInitialize() != VK_SUCCESS)
        throw DeviceError(
            "the Vulkan loader libvulkan.so.1 was not found: install it (Debian: apt install libvulkan1)");
    if (info.validation && !hasLayer(kValidationLayer))
        throw DeviceError("validation was asked for and its layer is not installed: apt install "
                          "vulkan-validationlayers, or unset Q3RT_VALIDATION");
    Instance made;
    made.debugUtils = hasExtension(nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) ||
                      (info.validation && hasExtension(kValidationLayer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME));
    std::vector<const char*> extensions;
    for (const std::string& name : info.extensions)
        extensions.push_back(name.c_str());
    if (made.debugUtils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (info.validation) extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);

    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "q3rt";
    application.pEngineName = "q3rt";
    application.apiVersion = VK_API_VERSION_1_2;

    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = onMessage;
    messenger.pUserData = info.messages;
    const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.pNext = &messenger;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enables;

    VkInstanceCreateInfo create{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    create.pApplicationInfo = &application;
    create.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    if (info.validation) {
        create.pNext = &features;
        create.enabledLayerCount = 1;
        create.ppEnabledLayerNames = &kValidationLayer;
    }
    checkResult(vkCreateInstance(&create, nullptr, &made.handle));
    // Device entry points through the loader: right for every device of the process, however many there are.
    volkLoadInstance(made.handle);
    if (info.validation)
        vkCheck(vkCreateDebugUtilsMessengerEXT(made.handle, &messenger, nullptr, &made.messenger),
                "vkCreateDebugUtilsMessengerEXT");
    return made;
}

void destroyInstance(Instance& instance) {
    if (instance.messenger) vkDestroyDebugUtilsMessengerEXT(instance.handle, instance.messenger, nullptr);
    if (instance.handle) vkDestroyInstance(instance.handle, nullptr);
    instance = {};
}

std::vector<VkPhysicalDevice> listPhysicalDevices(VkInstance instance) {
    uint32_t count = 0;
    const VkResult result = vkEnumeratePhysicalDevices(instance, &count, nullptr);
    if (result == VK_ERROR_INITIALIZATION_FAILED || (result == VK_SUCCESS && count == 0))
        failWithoutDriver("the Vulkan drivers found offer no device");
    vkCheck(result, "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    vkCheck(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
    return devices;
}

} // namespace q3rt
