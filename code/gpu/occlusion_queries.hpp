#pragma once
// Does anything of a draw pass its depth test? Asked in one frame, answered when its slot comes round. The frame copies
// the answers itself: to read a query from outside makes a software driver wait for the whole device.

#include <span>
#include <vector>

#include "gpu/buffer.hpp"

namespace q3rt {

class Device;

class OcclusionQueries {
  public:
    static constexpr uint32_t kUnanswered = ~0u;

    OcclusionQueries(Device& device, uint32_t framesInFlight);
    ~OcclusionQueries();
    OcclusionQueries(const OcclusionQueries&) = delete;
    OcclusionQueries& operator=(const OcclusionQueries&) = delete;

    /// Finds what the frame last in this slot asked (it has finished).
    void beginFrame(uint32_t slot, uint64_t frame);
    /// Room for this frame's questions; outside of rendering.
    void reserve(VkCommandBuffer commands, uint32_t count);
    /// Inside rendering, around draws; `number` below what was reserved.
    void begin(VkCommandBuffer commands, uint32_t number);
    void end(VkCommandBuffer commands, uint32_t number);
    /// Of questions that have all been asked; outside of rendering.
    void answer(VkCommandBuffer commands, uint32_t first, uint32_t count);
    /// The frame's commands will never run.
    void abandonFrame() { m_slots[m_slot].count = 0; }

    /// By number: 0 if nothing passed, or kUnanswered; of frame answeredFrame(). Until reserve().
    std::span<const uint32_t> answers() const { return m_answers; }
    uint64_t answeredFrame() const { return m_answeredFrame; }

  private:
    struct Slot {
        VkQueryPool pool = VK_NULL_HANDLE;
        Buffer answers;
        uint32_t capacity = 0, count = 0;
        uint64_t frame = 0;
    };
    Device& m_device;
    std::vector<Slot> m_slots;
    uint32_t m_slot = 0;
    std::span<const uint32_t> m_answers;
    uint64_t m_answeredFrame = 0;
};

} // namespace q3rt
