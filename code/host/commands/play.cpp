// q3rt play: the packaged engine with one of our renderers.

#include <cstdio>
#include <cstdlib>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/commands/commands.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/json_text.hpp"
#include "host/common/option_checks.hpp"
#include "host/common/output_file.hpp"
#include "host/common/progress.hpp"
#include "host/common/setting_checks.hpp"
#include "host/inspect/lost_light_files.hpp"
#include "host/packaged/engine_process.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

struct PlayArguments {
    EngineRun run;
    std::string demo, renderer = "rt", out, stats;
    int every = 100;
    bool json = false, relight = false;
};

bool hasDisplay() {
    const auto isSet = [](const char* name) {
        const char* value = std::getenv(name);
        return value && *value;
    };
    return isSet("DISPLAY") || isSet("WAYLAND_DISPLAY");
}

/// What a watched run leaves: pictures, a line a frame, and the figures for the summary.
class PlayReport {
  public:
    PlayReport(const PlayArguments& arguments, size_t expectedFrames)
        : m_folder(arguments.out)
        , m_stats(arguments.stats)
        , m_progress("frame", expectedFrames) {}
    void take(const WatchedFrame& frame) {
        if (frame.frame == WatchMessage::kStarted) {
            m_device = frame.text;
            return;
        }
        m_times.push_back(frame.wallMs);
        if (frame.picture.width > 0 && m_folder.isWanted()) {
            writePng(m_folder.path() / formatText("%08d.png", frame.frame), frame.picture);
            ++m_pictures;
        }
        if (m_stats.isWanted()) m_stats.append(statsLine(frame.frame, frame.wallMs, frame.text));
        m_progress.advance(m_times.size());
    }
    void print(bool json) const {
        const TimeSummary times = summarizeTimes(m_times);
        const nlohmann::ordered_json line = {{"frames", times.count},
                                             {"median_ms", times.medianMs},
                                             {"p99_ms", times.p99Ms},
                                             {"device", m_device},
                                             {"pictures", m_pictures}};
        if (m_folder.isWanted()) {
            const std::string text = toJsonText(line) + "\n";
            writeFileBytes(m_folder.path() / "summary.json", std::as_bytes(std::span(text)));
        }
        if (json)
            std::printf("%s\n", toJsonText(line).c_str());
        else
            std::printf("%s, median %.2f ms, 99th percentile %.2f ms, device %s, %s%s%s\n",
                        countOf(times.count, "frame").c_str(), times.medianMs, times.p99Ms, m_device.c_str(),
                        countOf(m_pictures, "picture").c_str(), m_folder.isWanted() ? " in " : "",
                        m_folder.path().c_str());
    }
    size_t frameCount() const { return m_times.size(); }

  private:
    OutputFolder m_folder;
    LineFile m_stats;
    Progress m_progress;
    std::vector<double> m_times;
    std::string m_device;
    size_t m_pictures = 0;
};

void runPlay(PlayArguments& a) {
    EngineRun& run = a.run;
    run.headless = run.headless || !hasDisplay();
    if (run.headless && a.demo.empty() && (run.map.empty() || run.frameLimit == 0))
        throw CLI::ValidationError("play",
                                   "a game without a display needs an end: give --demo, or --map with --frames");
    const CvarList others = requireKnownSettings(run.cvars);
    run.module = findModule(a.renderer);
    const auto files = openGame(run.game);
    if (!a.demo.empty()) run.demo = findDemo(*files, a.demo);
    if (!run.map.empty()) readMap(*files, run.map);
    if (a.relight) ensureLostLights(*files, run.game, run.map);
    run.timed = run.timed || run.headless;
    const bool reports = run.headless || !a.out.empty() || !a.stats.empty() || run.frameLimit > 0 || a.json;
    run.watched = reports || !others.empty(); // what only the interposer can do or tell
    run.wantsStats = !a.stats.empty();
    run.pictureEvery = a.out.empty() ? 0 : a.every;
    size_t expected = run.demo.snapshots;
    if (run.frameLimit > 0) expected = static_cast<size_t>(run.frameLimit);
    PlayReport report(a, expected);
    runEngine(run, [&](const WatchedFrame& frame) {
        if (reports) report.take(frame);
    });
    if (!reports) return;
    if (report.frameCount() == 0) throw DeviceError("the engine ended before it drew the world");
    report.print(a.json);
}

} // namespace

void addPlayCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand(
        "play", "Play a demo or a map in the packaged engine; without a display, as fast as it draws, into pictures");
    const auto a = std::make_shared<PlayArguments>();
    CLI::Option* demo = command->add_option("--demo", a->demo, "Demo of the game, such as demo088-test1");
    CLI::Option* map = addMapOption(*command, a->run.map)->excludes(demo);
    command->add_flag("--relight", a->relight, "Before that, recover the light that the map lost, unless that is done")
        ->needs(map);
    addRendererOption(*command, a->renderer);
    command->add_flag("--headless", a->run.headless, "No window (the default where there is no display)");
    addSizeOption(*command, a->run.size, "the game's; headless 640x480");
    addSetOption(*command, a->run.cvars);
    command->add_flag("--timedemo", a->run.timed, "Draw each frame of the demo once, as fast as possible")->needs(demo);
    command->add_option("--frames", a->run.frameLimit, "Stop after so many frames of the world")->check(wholeNumber(1));
    command->add_option("--out", a->out, "Folder for PNG pictures and summary.json");
    command->add_option("--every", a->every, "Keep the picture of every N-th frame")
        ->check(wholeNumber(1))
        ->capture_default_str();
    command->add_option("--stats", a->stats, "File for one JSON object a frame");
    command->add_flag("--json", a->json, "Print the summary as one JSON object");
    addGameOptions(*command, a->run.game);
    command->footer("Example: q3rt play --map oa_dm1 --renderer rt --set rt_preset=fast --set rt_targetMs=16");
    command->callback([a, &exitCode] {
        runPlay(*a);
        exitCode = 0;
    });
}

} // namespace q3rt
