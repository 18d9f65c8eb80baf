#include "renderer_rt/frame_time_controller.hpp"

#include <algorithm>
#include <cmath>

namespace q3rt {

namespace {

/// Frames. A window is long enough to see what a level takes, short against a change of scene (a second at 60).
constexpr size_t kWindow = 12, kLearned = 4, kBeyondInARow = 2;
/// A level that is left within so many frames of its arrival was a mistake.
constexpr uint64_t kTrialFrames = 90;
constexpr uint64_t kFirstWait = 120, kLongestWait = 7200;
/// Frames at one level after which the next is tried although it is predicted to be too dear: predictions may be stale.
constexpr uint64_t kPatience = 600;
/// Shares of the target: beyond it counts as too long; predictions keep room for what scatters; with ample room nothing
/// waits.
constexpr double kTooLong = 1.05, kRoom = 0.95, kAmpleRoom = 0.75;

double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

FrameTimeController::FrameTimeController(std::vector<double> costs, size_t start)
    : m_levels(costs.size())
    , m_level(std::min(start, costs.size() - 1)) {
    for (size_t i = 1; i < costs.size(); ++i)
        m_levels[i].ratio = std::max(1.0, costs[i] / costs[i - 1]);
}

double FrameTimeController::predict(size_t level, double ms) const {
    for (size_t i = m_level; i < level; ++i)
        ms *= m_levels[i + 1].ratio;
    for (size_t i = m_level; i > level; --i)
        ms /= m_levels[i].ratio;
    return ms;
}

void FrameTimeController::learn() {
    if (m_learned || m_window.size() < kLearned) return;
    m_learned = true;
    const size_t low = std::min(m_level, m_previousLevel), high = std::max(m_level, m_previousLevel);
    const double now = medianOf(m_window);
    const double seen = m_level > m_previousLevel ? now / m_previousMs : m_previousMs / now;
    double expected = 1;
    for (size_t i = low + 1; i <= high; ++i)
        expected *= m_levels[i].ratio;
    // Half of the error, spread evenly: the scene may have changed too.
    const double correction = std::pow(seen / expected, 0.5 / static_cast<double>(high - low));
    for (size_t i = low + 1; i <= high; ++i)
        m_levels[i].ratio = std::max(1.0, m_levels[i].ratio * correction);
}

void FrameTimeController::moveTo(size_t level) {
    m_previousLevel = m_level;
    m_previousMs = medianOf(m_window);
    m_learned = false;
    m_arrivedFromBelow = level > m_level;
    m_level = level;
    m_arrivedAt = m_frame;
    m_window.clear();
    ++m_changeCount;
}

void FrameTimeController::moveDown(double ms, double targetMs) {
    Level& here = m_levels[m_level];
    // Was the level too dear all along, or has the load risen?
    const bool failed = m_arrivedFromBelow && m_frame - m_arrivedAt < kTrialFrames;
    const bool onTheEdge = m_window.size() == kWindow && medianOf(m_window) > kRoom * targetMs;
    here.waitFrames =
        failed || onTheEdge ? std::clamp(2 * here.waitFrames, kFirstWait, kLongestWait) : here.waitFrames / 2;
    here.left = true;
    here.leftAt = m_frame;
    size_t level = m_level - 1;
    while (level > 0 && predict(level, ms) > kRoom * targetMs)
        --level;
    moveTo(level);
}

void FrameTimeController::moveUpIfRoom(double targetMs) {
    if (m_level + 1 == m_levels.size() || m_window.size() < kWindow) return;
    // The second longest: one that stands out is no sign of what the level takes.
    std::vector<double> sorted = m_window;
    std::nth_element(sorted.begin(), sorted.end() - 2, sorted.end());
    const double longest = *(sorted.end() - 2);
    const Level& next = m_levels[m_level + 1];
    const bool waits = next.left && m_frame - next.leftAt < next.waitFrames;
    const bool patient = m_frame - m_arrivedAt >= kPatience && longest < kRoom * targetMs;
    const double predicted = predict(m_level + 1, longest);
    if (predicted <= kAmpleRoom * targetMs || (!waits && (predicted <= kRoom * targetMs || patient)))
        moveTo(m_level + 1);
}

void FrameTimeController::addFrame(size_t drawnLevel, double ms, double targetMs) {
    ++m_frame;
    if (!std::isfinite(ms) || ms <= 0 || drawnLevel != m_level) return;
    m_window.push_back(ms);
    if (m_window.size() > kWindow) m_window.erase(m_window.begin());
    learn();
    if (m_level > 0 && m_window.size() >= kBeyondInARow) {
        const double least = *std::min_element(m_window.end() - kBeyondInARow, m_window.end());
        if (least > kTooLong * targetMs) {
            moveDown(least, targetMs);
            return;
        }
    }
    moveUpIfRoom(targetMs);
}

} // namespace q3rt
