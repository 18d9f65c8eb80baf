#pragma once
// What a sweep looks at: views of a map at rest, or chosen frames of a recording.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/headless/replayer.hpp"
#include "host/still/map_stage.hpp"

namespace q3rt {

struct DrawnFrame {
    std::optional<HostFrame> picture;
    double wallMs = 0; ///< from the first call to the end of EndFrame
};

class TradeSource {
  public:
    virtual ~TradeSource() = default;
    /// For people: "oa_dm1", "fight.q3t".
    virtual std::string name() const = 0;
    /// Changes with everything that decides what is seen, but for the files that the module reads.
    virtual std::string identity() const = 0;
    const std::vector<std::string>& viewNames() const { return m_viewNames; }
    virtual FileSource& files() = 0;
    /// The module is loaded and not started.
    virtual void start(HeadlessEngine& engine, const PictureSize& size, const CvarList& settings) = 0;
    /// Draws what comes before a view, so that renderers with a memory have one: the frames before it in a recording,
    /// the view itself otherwise.
    virtual void approach(HeadlessEngine& engine, size_t view, int frames) = 0;
    /// Are those frames the view itself?
    virtual bool approachIsView() const = 0;
    virtual DrawnFrame draw(HeadlessEngine& engine, size_t view, bool capture) = 0;

  protected:
    std::vector<std::string> m_viewNames;
};

struct MapSourceOptions {
    std::string map;
    std::vector<std::string> places; ///< "x y z pitch yaw", spawn:N, spawn:A..B
    float fovDegrees = 90;
    int timeMs = 0;
};
std::unique_ptr<TradeSource> openMapSource(const MapSourceOptions& options, const GameChoice& game);

/// `frames`: numbers of world frames; empty: kDefaultFrameCount of them, evenly spread. `warmup` frames before each are
/// kept for approach().
std::unique_ptr<TradeSource> openRecordingSource(const std::string& path, std::vector<int> frames, int warmup,
                                                 const GameChoice& game);
inline constexpr int kDefaultFrameCount = 4;

/// spawn:A..B in full: spawn:A, spawn:A+1 ... spawn:B; anything else as it is. Throws UsageError.
std::vector<std::string> expandPlace(const std::string& place);

} // namespace q3rt
