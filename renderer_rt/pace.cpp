#include "renderer_rt/pace.hpp"

#include "renderer_rt/presets.hpp"

namespace q3rt {

namespace {

/// Frames whose times may still come; more than are ever in flight.
constexpr size_t kMostUnknown = 16;

std::vector<double> costsOfLevels() {
    std::vector<double> costs;
    for (const PaceLevel& level : paceLevels())
        costs.push_back(level.ms);
    return costs;
}

} // namespace

Pace::Pace()
    : m_controller(costsOfLevels(), 0) {}

void Pace::applyPreset(TraceSettings& settings) {
    if (const Preset* preset = findPreset(settings.rt_preset)) applySettings(preset->settings, settings);
}

void Pace::apply(TraceSettings& settings, uint64_t frame, uint64_t finished, double finishedMs) {
    applyPreset(settings);
    // A mean of frames wants them all alike.
    if (settings.rt_targetMs <= 0 || settings.rt_accumulate != 0) {
        m_drawn.clear();
        return;
    }
    while (!m_drawn.empty() && m_drawn.front().number <= finished) {
        if (m_drawn.front().number == finished)
            m_controller.addFrame(m_drawn.front().level, finishedMs, static_cast<double>(settings.rt_targetMs));
        m_drawn.pop_front();
    }
    m_drawn.push_back({frame, m_controller.level()});
    // A device without timers never says.
    if (m_drawn.size() > kMostUnknown) m_drawn.pop_front();
    applySettings(paceLevels()[m_controller.level()].settings, settings);
}

} // namespace q3rt
