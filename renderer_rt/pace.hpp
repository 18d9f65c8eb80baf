#pragma once
// rt_preset and rt_targetMs: what they make of a frame's settings.

#include <deque>

#include "renderer_rt/frame_time_controller.hpp"
#include "renderer_rt/trace_settings.hpp"

namespace q3rt {

class Pace {
  public:
    Pace();
    /// Changes `settings`, which are as the cvars say, for frame number `frame`. `finished`: the newest frame whose
    /// time is known (0: none), and its time on the device.
    void apply(TraceSettings& settings, uint64_t frame, uint64_t finished, double finishedMs);
    size_t level() const { return m_controller.level(); } ///< in paceLevels()

    /// rt_preset alone, where no frame is drawn yet.
    void applyPreset(TraceSettings& settings);

  private:
    FrameTimeController m_controller;
    struct DrawnFrame {
        uint64_t number = 0;
        size_t level = 0;
    };
    std::deque<DrawnFrame> m_drawn; ///< whose times are not known yet
};

} // namespace q3rt
