// q3rt view: one still picture of a map, from any point, by any module.

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/commands.hpp"
#include "host/file_bytes.hpp"
#include "host/session.hpp"
#include "host/still_scene.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

struct ViewArguments {
    std::string map, at = "spawn:0", renderer = "rt", out, stats;
    PictureSize size{640, 480};
    float fovDegrees = 90;
    int timeMs = 0, frames = 1;
    CvarList cvars;
    GameChoice game;
    bool json = false, verbose = false;
};

/// The file that a module writes its radiance to, before the output curve, when the cvar q3rt_radiance names it.
constexpr const char* kRadianceFile = "q3rt_radiance.pfm";

EyePoint findEye(const ViewArguments& a, const std::vector<MapEntity>& entities) {
    unsigned number = 0;
    char rest = 0;
    if (std::sscanf(a.at.c_str(), "spawn:%u%c", &number, &rest) == 1) {
        const std::vector<EyePoint> points = findSpawnPoints(entities);
        if (number >= points.size())
            throw UsageError(formatText("%s has %zu spawn points, numbered from 0: choose another --at", a.map.c_str(),
                                        points.size()));
        return points[number];
    }
    EyePoint eye;
    if (std::sscanf(a.at.c_str(), "%f %f %f %f %f %c", &eye.origin.x, &eye.origin.y, &eye.origin.z, &eye.pitchDegrees,
                    &eye.yawDegrees, &rest) != 5)
        throw UsageError("--at takes \"x y z pitch yaw\" or spawn:N, not '" + a.at + "'");
    return eye;
}

/// Registers the scene's models in the module. Missing ones are left out, as the game does.
void registerScene(HeadlessEngine& engine, std::vector<StillEntity>& scene) {
    for (StillEntity& still : scene) {
        if (still.model.empty()) continue;
        engine.enter(
            [&](const refexport_t& module) { still.entity.hModel = module.RegisterModel(still.model.c_str()); });
    }
    std::erase_if(scene, [](const StillEntity& still) { return !still.model.empty() && still.entity.hModel == 0; });
}

struct ViewResult {
    HostFrame picture;
    std::vector<double> wallMs;
    std::string stats;
};

ViewResult drawFrames(HeadlessEngine& engine, const ViewArguments& a, const std::vector<StillEntity>& scene,
                      const refdef_t& view) {
    ViewResult result;
    Progress progress("frame", static_cast<size_t>(a.frames));
    for (int i = 0; i < a.frames; ++i) {
        const bool last = i + 1 == a.frames;
        if (last) engine.cvars.preset("q3rt_radiance", a.out.ends_with(".pfm") ? kRadianceFile : "");
        const auto start = std::chrono::steady_clock::now();
        engine.enter([&](const refexport_t& module) {
            module.BeginFrame(0);
            module.ClearScene();
            for (const StillEntity& still : scene)
                module.AddRefEntityToScene(&still.entity);
            module.RenderScene(&view);
        });
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
    if (!a.out.ends_with(".pfm")) return writePng(a.out, result.picture);
    const auto radiance = engine.filesWritten().find(kRadianceFile);
    if (radiance == engine.filesWritten().end())
        throw UsageError(a.renderer + " gives no radiance: write a .png, or use --renderer rt");
    writeFileBytes(a.out, radiance->second);
}

void runView(const ViewArguments& a) {
    const auto files = openGame(a.game);
    const std::string mapFile = "maps/" + a.map + ".bsp";
    const auto bytes = files->read(mapFile);
    if (!bytes) throw ContentError(mapFile + " is not in the game's archives; choose another --map");
    const Bsp bsp = parseBsp(*bytes, mapFile);
    const std::vector<MapEntity> entities = parseEntities(bsp.entities);
    const EyePoint eye = findEye(a, entities);
    std::vector<StillEntity> scene = buildStillScene(bsp, entities);

    HeadlessEngine engine(*files);
    engine.clockMs = a.timeMs;
    for (const auto& [name, value] : CvarList{{"r_mode", "-1"},
                                              {"r_customwidth", std::to_string(a.size.width)},
                                              {"r_customheight", std::to_string(a.size.height)},
                                              {"r_fullscreen", "0"},
                                              {"r_swapInterval", "0"},
                                              {"q3rt_wantStats", "1"}})
        engine.cvars.preset(name, value);
    for (const auto& [name, value] : a.cvars)
        engine.cvars.preset(name, value);
    engine.showsMessages = a.verbose;
    engine.loadModule(findModule(a.renderer));
    engine.beginRegistration();
    engine.enter([&](const refexport_t& module) { module.LoadWorld(mapFile.c_str()); });
    registerScene(engine, scene);
    engine.enter([](const refexport_t& module) { module.EndRegistration(); });
    const glconfig_t& config = engine.config();
    const refdef_t view = makeView(eye, a.fovDegrees, config.vidWidth, config.vidHeight, a.timeMs);
    const ViewResult result = drawFrames(engine, a, scene, view);
    writeResult(engine, a, result);
    const TimeSummary times = summarizeTimes(result.wallMs);
    if (a.json)
        std::printf("%s\n", statsLine(a.frames, times.medianMs, result.stats).c_str());
    else
        std::printf("%s: %s at %dx%d, %zu frames, median %.2f ms (%s)\n", a.out.c_str(), mapFile.c_str(),
                    config.vidWidth, config.vidHeight, times.count, times.medianMs, config.renderer_string);
    engine.unloadModule();
}

} // namespace

void addViewCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("view", "Draw one still view of a map: movers at rest, no players, no HUD");
    const auto a = std::make_shared<ViewArguments>();
    command->add_option("--map", a->map, "Map name, such as oa_dm1")->required();
    command->add_option("--at", a->at, "\"x y z pitch yaw\" (units, degrees), or spawn:N for the N-th player start")
        ->capture_default_str();
    command->add_option("--fov", a->fovDegrees, "Horizontal field of view in degrees")
        ->check(CLI::Range(1.0f, 179.0f))
        ->capture_default_str();
    command->add_option("--time", a->timeMs, "The clock, in ms")->capture_default_str();
    command->add_option("--frames", a->frames, "Frames drawn of the same view; with rt_accumulate 1 their mean is kept")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_option("--out", a->out, "Picture to write: .png, or .pfm for radiance as floats")
        ->required()
        ->check([](const std::string& name) {
            return name.ends_with(".png") || name.ends_with(".pfm") ? std::string()
                                                                    : "'" + name + "' must end in .png or .pfm";
        });
    addRendererOption(*command, a->renderer);
    addSizeOption(*command, a->size);
    command->add_flag("--verbose", a->verbose, "Show the renderer's messages");
    addSetOption(*command, a->cvars);
    command->add_flag("--json", a->json, "Print time and statistics as one JSON object");
    addGameOptions(*command, a->game);
    command->callback([a, &exitCode] {
        runView(*a);
        exitCode = 0;
    });
}

} // namespace q3rt
