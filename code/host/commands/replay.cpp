// q3rt replay: a recording drawn again, by any module, without engine or game code.

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/commands/commands.hpp"
#include "host/common/interrupt.hpp"
#include "host/common/json_text.hpp"
#include "host/common/option_checks.hpp"
#include "host/common/output_file.hpp"
#include "host/common/progress.hpp"
#include "host/common/session.hpp"
#include "host/common/setting_checks.hpp"
#include "host/headless/replayer.hpp"
#include "host/still/map_stage.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

struct ReplayArguments {
    std::string trace, renderer = "rt", out, stats;
    PictureSize size;
    int first = -1, count = -1, warmup = 0, accumulate = 1, every = 1;
    CvarList cvars;
    GameChoice game;
    bool json = false, verbose = false;
};

/// Where pictures and statistics of drawn frames go.
class FrameOutput {
  public:
    explicit FrameOutput(const ReplayArguments& arguments)
        : m_folder(arguments.out)
        , m_stats(arguments.stats) {}
    bool wantsPictures() const { return m_folder.isWanted(); }
    bool wantsStats() const { return m_stats.isWanted(); }
    void store(int number, const Replayer::Result& result, const std::string& moduleStats) {
        if (result.picture && wantsPictures())
            writePng(m_folder.path() / formatText("%08d.png", number), *result.picture);
        if (wantsStats()) m_stats.append(statsLine(number, result.wallMs, moduleStats));
    }

  private:
    OutputFolder m_folder;
    LineFile m_stats;
};

/// Draws one frame so often that an accumulating renderer has averaged `times` draws of it.
Replayer::Result drawFrame(Replayer& replayer, HeadlessEngine& engine, const Recording::Frame& frame, int times,
                           Replayer::Draw draw) {
    if (times <= 1) return replayer.play(frame, draw);
    replayer.play(frame, Replayer::Draw::Nothing);
    engine.cvars.preset("rt_accumulate", "1");
    Replayer::Result result;
    double wallMs = 0;
    for (int i = 0; i < times; ++i) {
        result = replayer.redraw(frame, i + 1 == times ? draw : Replayer::Draw::Frame);
        wallMs += result.wallMs;
    }
    result.wallMs = wallMs;
    engine.cvars.preset("rt_accumulate", "0");
    return result;
}

void printSummary(const ReplayArguments& arguments, const TimeSummary& times, const glconfig_t& config) {
    if (arguments.json) {
        const nlohmann::ordered_json line = {{"frames", times.count},      {"median_ms", times.medianMs},
                                             {"p99_ms", times.p99Ms},      {"width", config.vidWidth},
                                             {"height", config.vidHeight}, {"device", config.renderer_string}};
        std::printf("%s\n", toJsonText(line).c_str());
        return;
    }
    std::printf("%s at %dx%d: median %.2f ms, 99th percentile %.2f ms (%s)\n", countOf(times.count, "frame").c_str(),
                config.vidWidth, config.vidHeight, times.medianMs, times.p99Ms, config.renderer_string);
}

void runReplay(const ReplayArguments& arguments) {
    Recording recording{fs::path(arguments.trace)};
    const auto start = static_cast<int>(recording.info().firstFrame);
    const int available = start + static_cast<int>(recording.info().frameCount);
    const int first = arguments.first < 0 ? start : arguments.first;
    const long long end = arguments.count < 0 ? available : static_cast<long long>(first) + arguments.count;
    if (first < start || first >= available || end > available)
        throw UsageError(formatText("%s has world frames %d to %d; choose --first and --count within",
                                    arguments.trace.c_str(), start, available - 1));
    std::error_code isNoFile;
    if (fs::equivalent(arguments.stats, arguments.trace, isNoFile))
        throw UsageError(arguments.stats + ": is the recording itself; choose another --stats");
    RecordedFiles files(recording, arguments.game);
    FrameOutput output(arguments);
    HeadlessEngine engine(files);
    engine.showsMessages = arguments.verbose;
    engine.loadModule(findModule(arguments.renderer));
    if (output.wantsStats()) engine.cvars.preset("q3rt_wantStats", "1");
    Replayer replayer(recording, engine, {arguments.size.width, arguments.size.height, arguments.cvars, [&] {
                                              requireSettings(engine.cvars, arguments.cvars);
                                          }});
    Progress progress("frame", static_cast<size_t>(end - first));
    std::vector<double> times;
    for (size_t i = 0; i < recording.frameCount(); ++i) {
        const Recording::Frame frame = recording.readFrame(i);
        if (frame.number >= end) break;
        if (frame.number < first) {
            const bool warm = frame.number >= 0 && frame.number >= first - arguments.warmup;
            replayer.play(frame, warm ? Replayer::Draw::Frame : Replayer::Draw::Nothing);
            throwIfInterrupted();
            continue;
        }
        const bool chosen = (frame.number - first) % arguments.every == 0;
        const bool capture = output.wantsPictures() && chosen;
        const Replayer::Result result = drawFrame(replayer, engine, frame, arguments.accumulate,
                                                  capture ? Replayer::Draw::Capture : Replayer::Draw::Frame);
        output.store(frame.number, result, engine.cvars.value("q3rt_stats"));
        times.push_back(result.wallMs);
        progress.advance(times.size());
    }
    printSummary(arguments, summarizeTimes(times), engine.config());
    engine.unloadModule();
}

} // namespace

void addReplayCommand(CLI::App& app, int& exitCode) {
    CLI::App* command =
        app.add_subcommand("replay", "Draw a recording again, with any renderer, at any size, without the engine");
    const auto a = std::make_shared<ReplayArguments>();
    command->add_option("recording", a->trace, "The .q3t file")->required();
    addRendererOption(*command, a->renderer);
    addSizeOption(*command, a->size, "the recording's");
    command->add_option("--first", a->first, "First world frame to draw (default: the first one)")
        ->check(wholeNumber(0));
    command->add_option("--count", a->count, "Number of frames (default: to the end)")->check(wholeNumber(1));
    command->add_option("--warmup", a->warmup, "Frames before --first that are drawn but not kept")
        ->check(wholeNumber(0))
        ->capture_default_str();
    command->add_option("--accumulate", a->accumulate, "Draws of each frame that are averaged (rt_accumulate)")
        ->check(wholeNumber(1))
        ->capture_default_str();
    command->add_option("--every", a->every, "Keep the picture of every N-th frame only")
        ->check(wholeNumber(1))
        ->capture_default_str();
    command->add_option("--out", a->out, "Folder for PNG pictures, named by frame number");
    command->add_option("--stats", a->stats, "File for one JSON object a frame");
    command->add_flag("--json", a->json, "Print the summary as one JSON object");
    command->add_flag("--verbose", a->verbose, "Show the renderer's messages");
    addSetOption(*command, a->cvars);
    addGameOptions(*command, a->game);
    command->footer("Example: q3rt replay demo.q3t --renderer vk --size 1920x1080 --every 10 --out pictures");
    command->callback([a, &exitCode] {
        runReplay(*a);
        exitCode = 0;
    });
}

} // namespace q3rt
