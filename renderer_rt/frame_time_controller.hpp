#pragma once
// Holds a frame time by moving along a list of levels, each dearer and better than the one before. Pure.
//
// Down is quick: two frames in a row beyond the target move to the level whose predicted time keeps it. Up is slow and
// one level at a time: a window of frames must leave room for the next level's predicted time. A level that was tried
// and left soon after is not tried again for twice as long as the time before, so that a load which fits between two
// levels changes level ever more rarely: at most about log2(frames) times.
// Predictions are ratios of neighbouring levels' costs, learned from what each change did.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace q3rt {

class FrameTimeController {
  public:
    /// Costs of the levels, rising, in any unit; not empty. Starts at level `start`.
    FrameTimeController(std::vector<double> costs, size_t start);

    /// Hears the time of a finished frame and the level that it was drawn at. What is no time (NaN, infinite, not above
    /// 0) and frames of a level that has been left are not counted.
    void addFrame(size_t drawnLevel, double ms, double targetMs);
    /// Of the next frame to be drawn.
    size_t level() const { return m_level; }
    uint64_t changeCount() const { return m_changeCount; }

  private:
    struct Level {
        double ratio = 1;        ///< cost over that of the level below, as learned
        uint64_t waitFrames = 0; ///< after it was left, until it is tried again
        uint64_t leftAt = 0;     ///< frame
        bool left = false;       ///< because it was too dear
    };
    double predict(size_t level, double ms) const;
    void learn();
    void moveDown(double ms, double targetMs);
    void moveUpIfRoom(double targetMs);
    void moveTo(size_t level);

    std::vector<Level> m_levels;
    size_t m_level;
    std::vector<double> m_window; ///< times at this level, newest last
    uint64_t m_frame = 0, m_arrivedAt = 0, m_changeCount = 0;
    bool m_arrivedFromBelow = false, m_learned = true;
    size_t m_previousLevel = 0;
    double m_previousMs = 0; ///< before the last change
};

} // namespace q3rt
