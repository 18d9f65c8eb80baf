// q3rt record: a demo played in the real engine, the renderer's calls written down.

#include <cstdio>
#include <fstream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/commands/commands.hpp"
#include "host/common/json_text.hpp"
#include "host/common/option_checks.hpp"
#include "host/common/output_file.hpp"
#include "host/common/progress.hpp"
#include "host/common/setting_checks.hpp"
#include "host/packaged/engine_process.hpp"
#include "trace/recording_format.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

struct RecordArguments {
    EngineRun run;
    std::string demo, out, pictures, renderer = "null";
    int every = 1;
    bool json = false;
};

void runRecord(RecordArguments& a) {
    EngineRun& run = a.run;
    requireKnownSettings(run.cvars);
    run.module = findModule(a.renderer);
    run.demo = findDemo(*openGame(run.game), a.demo);
    run.headless = run.timed = run.watched = true;
    OutputFile output(fs::absolute(a.out));
    if (output.isStream()) throw UsageError(a.out + ": a recording is read again as it is made; name a regular file");
    run.recordTo = output.temporary();
    run.recordingName = a.out;
    const OutputFolder pictures(a.pictures);
    run.pictureEvery = pictures.isWanted() ? a.every : 0;
    const long long end = static_cast<long long>(run.recordFirst) + run.recordCount;
    {
        Progress progress("frame", run.recordCount > 0 ? static_cast<size_t>(end) : run.demo.snapshots);
        runEngine(run, [&](const WatchedFrame& frame) {
            if (frame.frame < 0) return;
            const bool isKept = frame.frame >= run.recordFirst && (run.recordCount == 0 || frame.frame < end);
            if (isKept && frame.picture.width > 0)
                writePng(pictures.path() / formatText("%08d.png", frame.frame), frame.picture);
            progress.advance(static_cast<size_t>(frame.frame) + 1);
        });
    }
    const Recording recording(std::make_unique<std::ifstream>(run.recordTo, std::ios::binary), a.out);
    const TraceInfo& info = recording.info();
    const uintmax_t bytes = fs::file_size(run.recordTo);
    if (info.frameCount == 0)
        throw ContentError(a.out + " would hold no frame of the world: the demo is shorter than --first");
    output.commit();
    if (a.json) {
        const nlohmann::ordered_json line = {{"recording", a.out},
                                             {"frames", info.frameCount},
                                             {"first", info.firstFrame},
                                             {"loading_frames", info.loadingFrameCount},
                                             {"map", info.map},
                                             {"width", info.width},
                                             {"height", info.height},
                                             {"files", recording.files().size()},
                                             {"bytes", bytes}};
        std::printf("%s\n", toJsonText(line).c_str());
    } else {
        std::printf("%s: %s of %s at %dx%d, %u loading frames, %zu files read, %.1f MB\n", a.out.c_str(),
                    countOf(info.frameCount, "frame").c_str(), info.map.c_str(), info.width, info.height,
                    info.loadingFrameCount, recording.files().size(), static_cast<double>(bytes) / 1e6);
    }
}

} // namespace

void addRecordCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand(
        "record", "Play a demo in the packaged engine and record what it asks of the renderer, frame by frame");
    const auto a = std::make_shared<RecordArguments>();
    command->add_option("--demo", a->demo, "Demo of the game, such as demo088-test1")->required();
    command->add_option("--out", a->out, "Recording to write (.q3t)")->required();
    command->add_option("--first", a->run.recordFirst, "First world frame to keep")->check(wholeNumber(0, kMostFrames));
    command->add_option("--count", a->run.recordCount, "Number of frames to keep (default: to the end)")
        ->check(wholeNumber(1));
    addRendererOption(*command, a->renderer);
    command->add_option("--pictures", a->pictures,
                        "Folder for the recorded renderer's own pictures, named by frame number as replay names them");
    command->add_option("--every", a->every, "With --pictures: keep every N-th frame's, counted from the demo's start")
        ->check(wholeNumber(1))
        ->capture_default_str();
    addSizeOption(*command, a->run.size, "the engine's, 640x480");
    addSetOption(*command, a->run.cvars);
    command->add_flag("--json", a->json, "Print the summary as one JSON object");
    addGameOptions(*command, a->run.game);
    command->footer("Example: q3rt record --demo demo088-test1 --first 600 --count 300 --out demo.q3t");
    command->callback([a, &exitCode] {
        runRecord(*a);
        exitCode = 0;
    });
}

} // namespace q3rt
