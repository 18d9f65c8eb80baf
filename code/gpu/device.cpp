#include "gpu/device.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>

#include "base/error.hpp"
#include "base/log.hpp"
#include "gpu/device_features.hpp"
#include "gpu/sampler.hpp"

namespace q3rt {
namespace {

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// Ray-tracing GPU, then GPU, then software; among equals discrete before integrated before virtual.
int rankDevice(const Capabilities& can) {
    int rank = 0;
    if (!can.software) rank += 100;
    if (can.hardwareTracing()) rank += 10;
    switch (can.type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return rank + 3;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return rank + 2;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return rank + 1;
    default:
        return rank;
    }
}

bool matchesWanted(const Capabilities& can, size_t index, const std::string& wanted) {
    size_t number = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    if (error == std::errc{} && end == wanted.data() + wanted.size()) return number == index;
    return lowered(can.deviceName).find(lowered(wanted)) != std::string::npos;
}

} // namespace

Device::Device(const DeviceOptions& options) {
    try {
        create(options);
    } catch (...) {
        destroyAll();
        throw;
    }
}

Device::~Device() { destroyAll(); }

void Device::create(const DeviceOptions& options) {
    m_validating = options.validation || environment("Q3RT_VALIDATION") == "1";
    m_instance = createInstance({m_validating, options.instanceExtensions, m_messages.get()});
    m_createSurface = options.createSurface;
    if (m_createSurface) remakeSurface();
    choosePhysical(options.wanted.empty() ? environment("Q3RT_DEVICE") : options.wanted);
    chooseQueueFamily();
    createDevice(options);
    logLine(LogLevel::Developer, "Vulkan device: %s", describeCapabilities(m_capabilities).c_str());
}

void Device::remakeSurface() {
    if (m_surface) vkDestroySurfaceKHR(m_instance.handle, m_surface, nullptr);
    m_surface = VK_NULL_HANDLE;
    m_surface = m_createSurface(m_instance.handle);
    if (!m_surface) throw DeviceError("the window system made no Vulkan surface for the window: run headless");
}

void Device::choosePhysical(const std::string& wanted) {
    const std::vector<VkPhysicalDevice> devices = listPhysicalDevices(m_instance.handle);
    std::string all;
    int bestRank = -1;
    bool found = false;
    for (size_t i = 0; i < devices.size(); ++i) {
        Capabilities can = readCapabilities(devices[i], m_surface != VK_NULL_HANDLE);
        all += formatText("%s%zu: %s", i ? "; " : "", i, describeCapabilities(can).c_str());
        if (!wanted.empty() && !matchesWanted(can, i, wanted)) continue;
        found = true;
        if (!can.usable() || rankDevice(can) <= bestRank) continue;
        bestRank = rankDevice(can);
        m_physical = devices[i];
        m_capabilities = std::move(can);
    }
    if (!found)
        throw DeviceError(formatText("no Vulkan device is called \"%s\": name another one with r_device or "
                                     "Q3RT_DEVICE; there is %s",
                                     wanted.c_str(), all.c_str()));
    m_choiceReason = !wanted.empty()       ? formatText("asked for as \"%s\"", wanted.c_str())
                     : devices.size() == 1 ? "the only one"
                                           : "the best: one that traces rays in hardware, any GPU, a software device";
    if (devices.size() > 1) m_choiceReason += "; there is " + all;
    if (bestRank < 0)
        throw DeviceError(formatText("no Vulkan device will do; there is %s. Update its driver or install Mesa 24.1 "
                                     "or newer",
                                     all.c_str()));
}

void Device::chooseQueueFamily() {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(m_physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(m_physical, &count, families.data());
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; ++i) {
        if ((families[i].queueFlags & kNeeded) != kNeeded) continue;
        VkBool32 presents = VK_TRUE;
        if (m_surface)
            vkCheck(vkGetPhysicalDeviceSurfaceSupportKHR(m_physical, i, m_surface, &presents),
                    "vkGetPhysicalDeviceSurfaceSupportKHR");
        if (!presents) continue;
        m_queueFamily = i;
        m_capabilities.timestampBits = families[i].timestampValidBits;
        return;
    }
    throw DeviceError(formatText("%s has no queue that draws, computes%s: choose another device (Q3RT_DEVICE)",
                                 m_capabilities.deviceName.c_str(), m_surface ? " and presents to this window" : ""));
}

void Device::createDevice(const DeviceOptions& options) {
    DeviceFeatures features(m_physical);
    features.keepWanted();
    const std::vector<const char*> extensions = features.extensions(m_surface != VK_NULL_HANDLE);
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = m_queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo create{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    create.pNext = &features.core;
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    create.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    vkCheck(vkCreateDevice(m_physical, &create, nullptr, &m_device), "vkCreateDevice");
    vkGetDeviceQueue(m_device, m_queueFamily, 0, &m_queue);

    VkPipelineCacheCreateInfo cache{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    cache.initialDataSize = options.pipelineCache.size();
    cache.pInitialData = options.pipelineCache.data();
    vkCheck(vkCreatePipelineCache(m_device, &cache, nullptr, &m_pipelineCache), "vkCreatePipelineCache");
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = m_queueFamily;
    vkCheck(vkCreateCommandPool(m_device, &pool, nullptr, &m_immediatePool), "vkCreateCommandPool");
    m_memory = std::make_unique<MemoryAllocator>(m_physical, m_device, true);
    m_samplers = std::make_unique<SamplerCache>(*this);
}

void Device::destroyAll() {
    if (m_device) {
        // A lost device returns an error here and still has to be taken apart.
        vkDeviceWaitIdle(m_device);
        while (!m_retired.empty()) {
            const Retired object = std::move(m_retired.front());
            m_retired.pop_front();
            object.destroy();
        }
        m_samplers.reset();
        if (m_memory && m_memory->measureUse().allocationCount > 0)
            logLine(LogLevel::Warning, "the Vulkan device is destroyed with %zu allocations still held",
                    m_memory->measureUse().allocationCount);
        m_memory.reset();
        vkDestroyCommandPool(m_device, m_immediatePool, nullptr);
        vkDestroyPipelineCache(m_device, m_pipelineCache, nullptr);
        vkDestroyDevice(m_device, nullptr);
        m_device = VK_NULL_HANDLE;
    }
    if (m_surface) vkDestroySurfaceKHR(m_instance.handle, m_surface, nullptr);
    m_surface = VK_NULL_HANDLE;
    destroyInstance(m_instance);
}

std::vector<std::byte> Device::pipelineCacheData() const {
    size_t size = 0;
    vkCheck(vkGetPipelineCacheData(m_device, m_pipelineCache, &size, nullptr), "vkGetPipelineCacheData");
    std::vector<std::byte> data(size);
    vkCheck(vkGetPipelineCacheData(m_device, m_pipelineCache, &size, data.data()), "vkGetPipelineCacheData");
    data.resize(size);
    return data;
}

void Device::retire(std::function<void()> destroy) {
    const uint64_t lastUser = m_framesSubmitted + (m_frameOpen ? 1 : 0);
    if (lastUser <= m_framesFinished && !m_recordingImmediate)
        destroy();
    else
        m_retired.push_back({lastUser, std::move(destroy)});
}

void Device::noteFramesFinished(uint64_t lastFinished) {
    m_framesFinished = std::max(m_framesFinished, lastFinished);
    if (m_recordingImmediate) return;
    while (!m_retired.empty() && m_retired.front().frame <= m_framesFinished) {
        const Retired object = std::move(m_retired.front());
        m_retired.pop_front();
        object.destroy();
    }
}

void Device::submitAndWait(const std::function<void(VkCommandBuffer)>& record) {
    if (m_recordingImmediate) throw UsageError("Device::submitAndWait is called from within itself");
    // An exception from `record` leaves nothing behind; what is retired meanwhile may be in these commands.
    struct Scope {
        Device& device;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        explicit Scope(Device& owner)
            : device(owner) {
            device.m_recordingImmediate = true;
        }
        ~Scope() {
            device.m_recordingImmediate = false;
            if (commands) vkFreeCommandBuffers(device.m_device, device.m_immediatePool, 1, &commands);
            device.noteFramesFinished(device.m_framesFinished);
        }
    } scope(*this);
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = m_immediatePool;
    allocate.commandBufferCount = 1;
    vkCheck(vkAllocateCommandBuffers(m_device, &allocate, &scope.commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    vkCheck(vkBeginCommandBuffer(scope.commands, &begin), "vkBeginCommandBuffer");
    record(scope.commands);
    vkCheck(vkEndCommandBuffer(scope.commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &scope.commands;
    vkCheck(vkQueueSubmit(m_queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
    vkCheck(vkQueueWaitIdle(m_queue), "vkQueueWaitIdle");
    noteFramesFinished(m_framesSubmitted);
}

void Device::waitIdle() {
    vkCheck(vkDeviceWaitIdle(m_device), "vkDeviceWaitIdle");
    noteFramesFinished(m_framesSubmitted);
}

void Device::setName(VkObjectType type, uint64_t handle, const std::string& name) const {
    if (!m_instance.debugUtils) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    vkSetDebugUtilsObjectNameEXT(m_device, &info);
}

void Device::beginLabel(VkCommandBuffer commands, const char* name) const {
    if (!m_instance.debugUtils) return;
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = name;
    vkCmdBeginDebugUtilsLabelEXT(commands, &label);
}

void Device::endLabel(VkCommandBuffer commands) const {
    if (m_instance.debugUtils) vkCmdEndDebugUtilsLabelEXT(commands);
}

std::vector<Capabilities> listDevices() {
    const VkInstance before = volkGetLoadedInstance();
    Instance instance = createInstance({});
    std::vector<Capabilities> list;
    try {
        for (const VkPhysicalDevice device : listPhysicalDevices(instance.handle))
            list.push_back(readCapabilities(device, false));
    } catch (...) {
        destroyInstance(instance);
        if (before) volkLoadInstance(before);
        throw;
    }
    destroyInstance(instance);
    // volk's pointers are the process's: a living device keeps those of its own instance.
    if (before) volkLoadInstance(before);
    return list;
}

} // namespace q3rt
