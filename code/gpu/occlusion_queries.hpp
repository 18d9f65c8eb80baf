#pragma once
// Does anything of a draw pass its depth test? Asked in one frame, answered when its slot comes round: nothing waits.

#include <vector>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

class Device;

class OcclusionQueries {
  public:
    OcclusionQueries(Device& device, uint32_t framesInFlight);
    ~OcclusionQueries();
    OcclusionQueries(const OcclusionQueries&) = delete;
    OcclusionQueries& operator=(const OcclusionQueries&) = delete;

    /// Reads what the frame last in this slot asked (it has finished).
    void beginFrame(uint32_t slot, uint64_t frame);
    /// Room for this frame's questions; outside of rendering.
    void reserve(VkCommandBuffer commands, uint32_t count);
    /// Inside rendering, around draws; `number` below what was reserved.
    void begin(VkCommandBuffer commands, uint32_t number);
    void end(VkCommandBuffer commands, uint32_t number);
    /// The frame's commands will never run.
    void abandonFrame() { m_slots[m_slot].count = 0; }

    /// By number, 1 if anything passed; of frame answeredFrame().
    const std::vector<uint8_t>& answers() const { return m_answers; }
    uint64_t answeredFrame() const { return m_answeredFrame; }

  private:
    struct Slot {
        VkQueryPool pool = VK_NULL_HANDLE;
        uint32_t capacity = 0, count = 0;
        uint64_t frame = 0;
    };
    Device& m_device;
    std::vector<Slot> m_slots;
    uint32_t m_slot = 0;
    std::vector<uint8_t> m_answers;
    std::vector<uint32_t> m_results;
    uint64_t m_answeredFrame = 0;
};

} // namespace q3rt
