#pragma once
// Milliseconds of each pass by timestamps, read back a frame later, so nothing waits.

#include <string>
#include <string_view>
#include <vector>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

class Device;

struct TimerRow {
    std::string name;
    double ms = 0;
};

class GpuTimers {
  public:
    GpuTimers(Device& device, uint32_t framesInFlight);
    ~GpuTimers();
    GpuTimers(const GpuTimers&) = delete;
    GpuTimers& operator=(const GpuTimers&) = delete;

    /// Software drivers wait at each timestamp for what was drawn before: off, no row is made.
    bool enabled = true;
    /// Reads what the frame last in this slot measured (it has finished) and clears the slot.
    void beginFrame(VkCommandBuffer commands, uint32_t slot, uint64_t frame);
    /// The frame's commands will never run: forgets its rows.
    void abandonFrame() { m_slots[m_slot].names.clear(); }
    /// Rows may nest or follow each other; any number of them. A name used twice makes two rows.
    uint32_t begin(VkCommandBuffer commands, std::string_view name);
    void end(VkCommandBuffer commands, uint32_t row);
    /// Of the newest finished frame, in order of begin(). Empty if the device has no timestamps.
    const std::vector<TimerRow>& results() const { return m_results; }
    /// The frame that results() are of (FrameRing::frameNumber()); 0: none yet.
    uint64_t resultsFrame() const { return m_resultsFrame; }
    /// Reads a finished frame now (FrameRing::wait() for it), such as the last ones of a run.
    void collectFrame(uint64_t frame);

  private:
    struct Slot {
        std::vector<VkQueryPool> pools; // each of kRowsPerPool rows
        std::vector<std::string> names;
        uint64_t frame = 0;
    };
    void collect(Slot& slot);
    void ensurePool(VkCommandBuffer commands, Slot& slot, size_t pool);

    Device& m_device;
    std::vector<Slot> m_slots;
    uint32_t m_slot = 0;
    std::vector<TimerRow> m_results;
    uint64_t m_resultsFrame = 0;
};

} // namespace q3rt
