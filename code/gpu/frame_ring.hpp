#pragma once
// Frames in flight: command buffers, fences, per-frame descriptors and timers. The CPU only ever waits for the frame
// that used the same slot before.

#include <memory>
#include <vector>

#include "gpu/command_memory.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/gpu_timers.hpp"

namespace q3rt {

class Swapchain;
enum class Show;

class FrameRing {
  public:
    explicit FrameRing(Device& device, uint32_t framesInFlight = 2);
    ~FrameRing();
    FrameRing(const FrameRing&) = delete;
    FrameRing& operator=(const FrameRing&) = delete;

    /// Waits for the slot's last frame, retires what it used, begins the command buffer.
    VkCommandBuffer begin();
    /// Ends and submits. With a swapchain whose image was acquired this frame: waits for the image, presents it.
    void submit() { submit(nullptr, Show{}); }
    void submit(Swapchain* swapchain, Show show);
    /// Throws the begun commands away (after an error).
    void abandon();
    /// Waits until frame `number` (see frameNumber()) is done, for readback.
    void wait(uint64_t number);

    bool recording() const { return m_recording; }
    VkCommandBuffer commands() const { return m_slots[m_slot].commands; }
    uint32_t slot() const { return m_slot; } // [0, framesInFlight)
    uint32_t framesInFlight() const { return static_cast<uint32_t>(m_slots.size()); }
    /// Of the frame being recorded or, between frames, last submitted; the first is 1.
    uint64_t frameNumber() const { return m_frameNumber; }
    /// Sets made here live until this frame is done.
    DescriptorArena& descriptors() { return *m_slots[m_slot].descriptors; }
    GpuTimers& timers() { return m_timers; }
    Device& device() { return m_device; }

  private:
    struct Slot {
        std::shared_ptr<CommandMemory> memory = std::make_shared<CommandMemory>(); // of the pool
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
        uint64_t frame = 0; // last frame submitted from this slot; 0: none
        std::unique_ptr<DescriptorArena> descriptors;
    };
    void waitFor(Slot& slot);

    Device& m_device;
    GpuTimers m_timers;
    std::vector<Slot> m_slots;
    uint32_t m_slot = 0;
    uint64_t m_frameNumber = 0;
    bool m_recording = false;
};

} // namespace q3rt
