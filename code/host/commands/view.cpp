// q3rt view: one still picture of a map, from any point, by any module.

#include <climits>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/log.hpp"
#include "host/commands/commands.hpp"
#include "host/common/exr_file.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/option_checks.hpp"
#include "host/common/output_file.hpp"
#include "host/common/progress.hpp"
#include "host/common/setting_checks.hpp"
#include "host/still/map_stage.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

struct ViewArguments {
    std::string map, at = "spawn:0", renderer = "rt", out;
    PictureSize size{640, 480};
    float fovDegrees = 90;
    int timeMs = 0, frames = 1;
    CvarList cvars;
    GameChoice game;
    bool json = false, verbose = false;
};

/// The ray tracer's command writes the next frame's radiance, before the output curve, into a file named after it.
constexpr const char *kRadianceCommand = "screenshotHDR", *kRadianceName = "view",
                     *kRadianceFile = "screenshots/view.pfm";

/// Of a value 1.0 in a file of radiance.
constexpr const char* kRadianceUnit = "radiance; 1.0 = a white texture at irradiance 63.75 luxel units";

bool wantsRadiance(const std::string& name) { return name.ends_with(".pfm") || name.ends_with(".exr"); }

struct ViewResult {
    HostFrame picture;
    std::vector<double> wallMs;
    std::string stats;
};

ViewResult drawFrames(HeadlessEngine& engine, const ViewArguments& a, const MapStage& stage, const refdef_t& view) {
    ViewResult result;
    Progress progress("frame", static_cast<size_t>(a.frames));
    for (int i = 0; i < a.frames; ++i) {
        const bool last = i + 1 == a.frames;
        if (last && wantsRadiance(a.out)) engine.runCommand({kRadianceCommand, kRadianceName});
        const auto start = std::chrono::steady_clock::now();
        stage.drawScene(engine, view);
        auto picture = engine.endFrame(last);
        const auto end = std::chrono::steady_clock::now();
        result.wallMs.push_back(std::chrono::duration<double, std::milli>(end - start).count());
        if (picture) result.picture = std::move(*picture);
        progress.advance(static_cast<size_t>(i) + 1);
    }
    result.stats = engine.cvars.value("q3rt_stats");
    return result;
}

void writeResult(HeadlessEngine& engine, const ViewArguments& a, const ViewResult& result) {
    if (!wantsRadiance(a.out)) return writePng(a.out, result.picture);
    const auto radiance = engine.filesWritten().find(kRadianceFile);
    if (radiance == engine.filesWritten().end())
        throw UsageError(a.renderer + " gives no radiance: write a .png, or use --renderer rt");
    if (a.out.ends_with(".pfm")) return writeFileBytes(a.out, radiance->second);
    writeFileBytes(a.out, encodeExr(decodePfm(radiance->second, kRadianceFile), kRadianceUnit));
}

void runView(const ViewArguments& a) {
    checkWritable(a.out);
    const auto files = openGame(a.game);
    MapStage stage(*files, a.map);
    const EyePoint eye = stage.findEye(a.at);
    HeadlessEngine engine(*files);
    engine.clockMs = a.timeMs;
    presetPicture(engine.cvars, a.size, a.cvars);
    engine.showsMessages = a.verbose;
    engine.loadModule(findModule(a.renderer));
    stage.load(engine);
    requireSettings(engine.cvars, a.cvars);
    const glconfig_t& config = engine.config();
    const refdef_t view = makeView(eye, a.fovDegrees, config.vidWidth, config.vidHeight, a.timeMs);
    const ViewResult result = drawFrames(engine, a, stage, view);
    if (const std::string warnings = engine.unshownWarnings(); !warnings.empty())
        logLine(LogLevel::Warning, "%s", warnings.c_str());
    writeResult(engine, a, result);
    const TimeSummary times = summarizeTimes(result.wallMs);
    if (a.json)
        std::printf("%s\n", statsLine(a.frames, times.medianMs, result.stats).c_str());
    else
        std::printf("%s: %s at %dx%d, %s, median %.2f ms (%s)\n", a.out.c_str(), stage.file().c_str(), config.vidWidth,
                    config.vidHeight, countOf(times.count, "frame").c_str(), times.medianMs, config.renderer_string);
    engine.unloadModule();
}

} // namespace

void addViewCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("view", "Draw one still view of a map: movers at rest, no players, no HUD");
    const auto a = std::make_shared<ViewArguments>();
    addMapOption(*command, a->map)->required();
    command->add_option("--at", a->at, "\"x y z pitch yaw\" (units, degrees), or spawn:N for the N-th player start")
        ->check(checkedBy(parsePlace))
        ->capture_default_str();
    command->add_option("--fov", a->fovDegrees, "Horizontal field of view in degrees, 1 to 179")
        ->check(number(1, 179))
        ->capture_default_str();
    command->add_option("--time", a->timeMs, "The clock, in ms")->check(wholeNumber(INT_MIN))->capture_default_str();
    command->add_option("--frames", a->frames, "Frames drawn of the same view; with rt_accumulate 1 their mean is kept")
        ->check(wholeNumber(1))
        ->capture_default_str();
    command->add_option("--out", a->out, "Picture to write: .png, or .exr or .pfm for radiance as floats")
        ->required()
        ->check([](const std::string& name) {
            return name.ends_with(".png") || wantsRadiance(name) ? std::string()
                                                                 : "'" + name + "' must end in .png, .exr or .pfm";
        });
    addRendererOption(*command, a->renderer);
    addSizeOption(*command, a->size);
    command->add_flag("--verbose", a->verbose, "Show the renderer's messages");
    addSetOption(*command, a->cvars);
    command->add_flag("--json", a->json, "Print time and statistics as one JSON object");
    addGameOptions(*command, a->game);
    command->footer(
        "Example: q3rt view --map oa_dm1 --at spawn:2 --set rt_preset=quality --size 1280x720 --out view.png");
    command->callback([a, &exitCode] {
        runView(*a);
        exitCode = 0;
    });
}

} // namespace q3rt
