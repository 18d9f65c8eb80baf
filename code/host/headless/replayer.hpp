#pragma once
// Plays a recording's events into a module on the headless engine. Handles are translated from the recording's numbers
// to the module's; pixel coordinates from the recorded picture size to the chosen one.

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "host/headless/headless_engine.hpp"
#include "trace/recording.hpp"

namespace q3rt {

class Replayer {
  public:
    struct Options {
        int width = 0, height = 0;                              ///< pixels; 0: as recorded
        std::vector<std::pair<std::string, std::string>> cvars; ///< win over the recorded values
        std::function<void()> onStarted = {};                   ///< the module has declared its cvars; may throw
    };
    /// Sets the cvars; the module must be loaded and not started yet. Both objects outlive this one.
    Replayer(const Recording& recording, HeadlessEngine& engine, const Options& options);

    enum class Draw {
        Nothing, ///< only what outlasts the frame: registrations, cvars, uploads
        Frame,
        Capture ///< and give the picture
    };
    struct Result {
        std::optional<HostFrame> picture;
        double wallMs = 0; ///< from the frame's first event to the end of EndFrame
    };
    Result play(const Recording::Frame& frame, Draw draw);
    /// Draws the frame once more, without what outlasts it: the module was given that already.
    Result redraw(const Recording::Frame& frame, Draw draw);

  private:
    struct Player;
    Result run(const Recording::Frame& frame, Draw draw, bool stateful);
    void prepareCinematics(const Recording::Frame& frame);

    HeadlessEngine& m_engine;
    std::function<void()> m_onStarted;
    std::set<std::string> m_fixedCvars;                        ///< lower-case names that the recording doesn't change
    std::unordered_map<int, int> m_models, m_skins, m_shaders; ///< recording's number -> module's handle
    float m_scaleX = 1, m_scaleY = 1;
    std::map<std::string, int> m_cinematicHandles; ///< by lower-case name
    std::map<int, int> m_cinematicStatus;          ///< by handle
    std::map<int, event::Cinematic> m_cinematicPixels;
    std::vector<event::Point> m_markPoints; ///< what the module answers
    std::vector<markFragment_t> m_markFragments;
};

} // namespace q3rt
