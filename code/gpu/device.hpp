#pragma once
// The Vulkan instance, the chosen device and its one queue; memory; deferred destruction; validation messages.
// Everything in gpu/ is used from one thread. A Device outlives all that is made from it.

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu/capabilities.hpp"
#include "gpu/instance.hpp"
#include "gpu/memory.hpp"

namespace q3rt {

class SamplerCache;

struct DeviceOptions {
    /// Part of a device name (any case) or its index; empty chooses: ray-tracing GPU, then GPU, then software.
    /// The environment variable Q3RT_DEVICE stands in for an empty one.
    std::string wanted;
    /// Core and synchronisation validation. Q3RT_VALIDATION=1 in the environment asks for it too.
    bool validation = false;
    /// Extensions that the window system wants of the instance; with createSurface they make a presenting device.
    std::vector<std::string> instanceExtensions;
    /// Makes the window's surface. The Device owns and destroys it. Empty: headless.
    std::function<VkSurfaceKHR(VkInstance)> createSurface;
    /// Bytes of an earlier Device::pipelineCacheData(); foreign or stale data is ignored by the driver.
    std::vector<std::byte> pipelineCache;
};

class Device {
  public:
    /// Throws DeviceError with the remedy if there is no Vulkan loader, no driver, or no device that will do.
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    VkInstance instance() const { return m_instance.handle; }
    VkPhysicalDevice physical() const { return m_physical; }
    VkDevice handle() const { return m_device; }
    VkQueue queue() const { return m_queue; }
    uint32_t queueFamily() const { return m_queueFamily; }
    VkSurfaceKHR surface() const { return m_surface; } // null when headless
    /// The window system took the surface away: makes another one for the same window. No swapchain may be left.
    void remakeSurface();
    VkPipelineCache pipelineCache() const { return m_pipelineCache; }
    const Capabilities& capabilities() const { return m_capabilities; }
    /// Why this one of the machine's devices, for people.
    const std::string& choiceReason() const { return m_choiceReason; }
    MemoryAllocator& memory() { return *m_memory; }
    SamplerCache& samplers() { return *m_samplers; }

    /// For the caller to keep on disk.
    std::vector<std::byte> pipelineCacheData() const;

    /// Runs `destroy` once the GPU has finished every frame that may use the object. Destructors of handles call it.
    void retire(std::function<void()> destroy);
    /// Is a frame being recorded (FrameRing::begin() to submit())?
    bool frameOpen() const { return m_frameOpen; }
    /// Objects waiting for that.
    size_t retiredCount() const { return m_retired.size(); }

    /// Records, submits and waits: for loading and tests, never inside a steady frame.
    void submitAndWait(const std::function<void(VkCommandBuffer)>& record);
    void waitIdle();

    /// Names an object for validation messages and captures; nothing without debug utils.
    void setName(VkObjectType type, uint64_t handle, const std::string& name) const;
    void beginLabel(VkCommandBuffer commands, const char* name) const;
    void endLabel(VkCommandBuffer commands) const;

    /// Warnings and errors of the validation layer so far, oldest first; always empty without validation. Shared, so
    /// that what is said at the device's own destruction (leaks) can be read after it.
    std::shared_ptr<const std::vector<std::string>> validationMessages() const { return m_messages; }
    bool validating() const { return m_validating; }

  private:
    friend class FrameRing;
    struct Retired {
        uint64_t frame; // last frame that may use it
        std::function<void()> destroy;
    };
    void create(const DeviceOptions& options);
    void choosePhysical(const std::string& wanted);
    void chooseQueueFamily();
    void createDevice(const DeviceOptions& options);
    void destroyAll();
    // FrameRing tells where the GPU is: frames are numbered from 1.
    void noteFramesFinished(uint64_t lastFinished);

    Instance m_instance;
    VkSurfaceKHR m_surface = VK_NULL_HANDLE;
    std::function<VkSurfaceKHR(VkInstance)> m_createSurface;
    VkPhysicalDevice m_physical = VK_NULL_HANDLE;
    VkDevice m_device = VK_NULL_HANDLE;
    VkQueue m_queue = VK_NULL_HANDLE;
    uint32_t m_queueFamily = 0;
    VkPipelineCache m_pipelineCache = VK_NULL_HANDLE;
    VkCommandPool m_immediatePool = VK_NULL_HANDLE;
    Capabilities m_capabilities;
    std::string m_choiceReason;
    bool m_validating = false;
    std::shared_ptr<std::vector<std::string>> m_messages = std::make_shared<std::vector<std::string>>();
    std::unique_ptr<MemoryAllocator> m_memory;
    std::unique_ptr<SamplerCache> m_samplers;
    std::deque<Retired> m_retired; // frame numbers never fall
    uint64_t m_framesSubmitted = 0;
    uint64_t m_framesFinished = 0;
    bool m_frameOpen = false;
    bool m_recordingImmediate = false; // inside submitAndWait
};

/// Every device of every installed driver, for `q3rt doctor`. Throws DeviceError if there is no loader or driver.
std::vector<Capabilities> listDevices();

} // namespace q3rt
