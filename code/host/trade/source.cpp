#include "host/trade/source.hpp"

#include <algorithm>
#include <chrono>

#include "base/error.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/number_text.hpp"
#include "host/trade/points.hpp"

namespace q3rt {
namespace {

class MapSource : public TradeSource {
  public:
    MapSource(const MapSourceOptions& options, const GameChoice& game)
        : m_options(options)
        , m_files(openGame(game))
        , m_stage(*m_files, options.map) {
        for (const std::string& place : options.places)
            for (const std::string& single : expandPlace(place)) {
                m_eyes.push_back(m_stage.findEye(single));
                m_viewNames.push_back(single);
            }
    }
    std::string name() const override { return m_options.map; }
    std::string identity() const override {
        std::string text = formatText("map %s fov %g time %d", m_stage.file().c_str(),
                                      static_cast<double>(m_options.fovDegrees), m_options.timeMs);
        for (const EyePoint& eye : m_eyes)
            text += formatText(" at %.9g %.9g %.9g %.9g %.9g", eye.origin.x, eye.origin.y, eye.origin.z,
                               static_cast<double>(eye.pitchDegrees), static_cast<double>(eye.yawDegrees));
        return text;
    }
    FileSource& files() override { return *m_files; }
    void start(HeadlessEngine& engine, const PictureSize& size, const CvarList& settings) override {
        engine.clockMs = m_options.timeMs;
        presetPicture(engine.cvars, size, settings);
        m_stage.load(engine);
    }
    void approach(HeadlessEngine& engine, size_t view, int frames) override {
        for (int i = 0; i < frames; ++i)
            draw(engine, view, false);
    }
    bool approachIsView() const override { return true; }
    DrawnFrame draw(HeadlessEngine& engine, size_t view, bool capture) override {
        const glconfig_t& config = engine.config();
        const refdef_t seen =
            makeView(m_eyes[view], m_options.fovDegrees, config.vidWidth, config.vidHeight, m_options.timeMs);
        const auto start = std::chrono::steady_clock::now();
        m_stage.drawScene(engine, seen);
        DrawnFrame drawn{engine.endFrame(capture), 0};
        drawn.wallMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        return drawn;
    }

  private:
    MapSourceOptions m_options;
    std::unique_ptr<Pk3FileSource> m_files;
    MapStage m_stage;
    std::vector<EyePoint> m_eyes;
};

class RecordingSource : public TradeSource {
  public:
    RecordingSource(const std::string& path, std::vector<int> frames, int warmup, const GameChoice& game)
        : m_path(path)
        , m_contentHash(hashBytes(readFileBytes(path)))
        , m_recording(m_path)
        , m_files(m_recording, game)
        , m_chosen(std::move(frames))
        , m_warmup(warmup) {
        const auto first = static_cast<int>(m_recording.info().firstFrame);
        const auto count = static_cast<int>(m_recording.info().frameCount);
        if (count == 0) throw UsageError(path + " has no world frames: record more of the demo");
        if (m_chosen.empty())
            for (int i = 0; i < std::min(kDefaultFrameCount, count); ++i)
                m_chosen.push_back(first + static_cast<int>((2LL * i + 1) * count / (2LL * kDefaultFrameCount)));
        std::sort(m_chosen.begin(), m_chosen.end());
        m_chosen.erase(std::unique(m_chosen.begin(), m_chosen.end()), m_chosen.end());
        for (const int frame : m_chosen) {
            if (frame < first || frame >= first + count)
                throw UsageError(formatText("%s has world frames %d to %d, not %d; choose other --frames", path.c_str(),
                                            first, first + count - 1, frame));
            m_viewNames.push_back(formatText("frame:%d", frame));
        }
    }
    std::string name() const override { return m_path.filename().string(); }
    std::string identity() const override {
        std::string text = formatText("recording %016llx", static_cast<unsigned long long>(m_contentHash));
        for (const std::string& view : m_viewNames)
            text += " " + view;
        return text;
    }
    FileSource& files() override { return m_files; }
    void start(HeadlessEngine& engine, const PictureSize& size, const CvarList& settings) override {
        engine.cvars.preset("q3rt_wantStats", "1");
        m_replayer.emplace(m_recording, engine, Replayer::Options{size.width, size.height, settings});
        m_kept.clear();
        for (size_t i = 0; i < m_recording.frameCount(); ++i) {
            Recording::Frame frame = m_recording.readFrame(i);
            if (frame.number > m_chosen.back()) break;
            if (!m_kept.empty()) refuseRestart(frame);
            m_replayer->play(frame, Replayer::Draw::Nothing);
            const bool wanted = frame.number >= 0 && std::any_of(m_chosen.begin(), m_chosen.end(), [&](int chosen) {
                                    return frame.number <= chosen && frame.number >= chosen - m_warmup;
                                });
            if (wanted) m_kept[frame.number] = std::move(frame);
        }
    }
    void approach(HeadlessEngine& engine, size_t view, int frames) override {
        for (int number = m_chosen[view] - frames; number < m_chosen[view]; ++number) {
            const auto kept = m_kept.find(number);
            if (kept == m_kept.end())
                draw(engine, view, false);
            else
                m_replayer->redraw(kept->second, Replayer::Draw::Frame);
        }
    }
    bool approachIsView() const override { return false; }
    DrawnFrame draw(HeadlessEngine&, size_t view, bool capture) override {
        Replayer::Result result =
            m_replayer->redraw(m_kept.at(m_chosen[view]), capture ? Replayer::Draw::Capture : Replayer::Draw::Frame);
        return {std::move(result.picture), result.wallMs};
    }

  private:
    /// All views are drawn with what the module knows at the last one: handles of an earlier start mean nothing then.
    void refuseRestart(const Recording::Frame& frame) const {
        for (const TraceEvent& event : frame.events)
            if (std::holds_alternative<event::BeginRegistration>(event))
                throw UsageError(formatText("%s: the renderer starts anew between the chosen frames; choose --frames "
                                            "of one map only",
                                            m_path.c_str()));
    }

    std::filesystem::path m_path;
    uint64_t m_contentHash;
    Recording m_recording;
    RecordedFiles m_files;
    std::vector<int> m_chosen; ///< world frames, rising
    int m_warmup;
    std::optional<Replayer> m_replayer;
    std::map<int, Recording::Frame> m_kept; ///< chosen frames and those before them
};

} // namespace

std::vector<std::string> expandPlace(const std::string& place) {
    constexpr std::string_view kSpawn = "spawn:";
    const auto range =
        place.starts_with(kSpawn) ? parsePair<unsigned>(place.substr(kSpawn.size()), "..") : std::nullopt;
    if (!range) return {place};
    const auto [first, last] = *range;
    if (last < first) throw UsageError("'" + place + "': the last spawn point comes before the first");
    constexpr unsigned kMost = 1u << 16; // more than the engine takes entities of all kinds
    if (last - first >= kMost) throw UsageError("'" + place + "': no map has so many spawn points");
    std::vector<std::string> places;
    for (unsigned i = first; i <= last; ++i)
        places.push_back(formatText("spawn:%u", i));
    return places;
}

std::unique_ptr<TradeSource> openMapSource(const MapSourceOptions& options, const GameChoice& game) {
    return std::make_unique<MapSource>(options, game);
}

std::unique_ptr<TradeSource> openRecordingSource(const std::string& path, std::vector<int> frames, int warmup,
                                                 const GameChoice& game) {
    return std::make_unique<RecordingSource>(path, std::move(frames), warmup, game);
}

} // namespace q3rt
