#pragma once
// What a frame's shaders have counted, read when the frame is done: some frames later, so that nothing waits.

#include <array>
#include <string>
#include <vector>

#include "frame/frame_graph.hpp"
#include "gpu/buffer.hpp"
#include "shaders/shared/rt_report.h"

namespace q3rt {

class Device;

/// Of one frame.
struct ReportNumbers {
    double likeness = 0, error = 0; ///< means over the tiles of a picture; see shared/rt_report.h
    bool hasError = false;          ///< was there a mean of samples to measure
    struct Count {
        std::string pass;
        uint64_t nonFinite = 0;
    };
    std::vector<Count> counts; ///< of each checked pass
    std::array<uint32_t, kWorkKindCount> work{};
    uint64_t rayCount = 0;
};

class FrameReport {
  public:
    FrameReport(Device& device, uint32_t framesInFlight);
    /// Takes the numbers of the frame that was last in this slot: it is done.
    void beginFrame(uint32_t slot);
    VkDeviceAddress address() const { return m_counted.address(); }
    /// Number of a pass's counter in this frame.
    uint32_t counterOf(const std::string& pass);
    /// "report clear": all counts are 0.
    BufferId addClear(FrameGraph& graph);
    /// "report": the counts go where the CPU will read them.
    void addCopy(FrameGraph& graph, BufferId report);
    /// Of the newest frame that is done and had a report.
    const ReportNumbers& latest() const { return m_latest; }

  private:
    struct Slot {
        Buffer copy;
        std::vector<std::string> passes;
        bool filled = false;
    };
    Buffer m_counted;
    std::vector<Slot> m_slots;
    uint32_t m_slot = 0;
    ReportNumbers m_latest;
};

} // namespace q3rt
