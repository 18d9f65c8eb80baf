// q3rt subset: the smallest archive from which a map or a recording can be drawn.

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/commands/commands.hpp"
#include "host/common/json_text.hpp"
#include "host/common/output_file.hpp"
#include "host/common/progress.hpp"
#include "host/common/session.hpp"
#include "host/headless/replayer.hpp"
#include "host/still/map_stage.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

struct SubsetArguments {
    std::string map, trace, out;
    GameChoice game;
    bool json = false;
};

void loadTrace(HeadlessEngine& engine, Recording& recording) {
    Replayer replayer(recording, engine, {});
    Progress progress("frame", recording.frameCount());
    for (size_t i = 0; i < recording.frameCount(); ++i) {
        replayer.play(recording.readFrame(i), Replayer::Draw::Nothing);
        progress.advance(i + 1);
    }
}

void runSubset(const SubsetArguments& a) {
    OutputFile output(a.out);
    std::unique_ptr<Recording> recording;
    std::unique_ptr<FileSource> files;
    std::optional<MapStage> stage;
    if (a.map.empty()) {
        recording = std::make_unique<Recording>(fs::path(a.trace));
        files = std::make_unique<RecordedFiles>(*recording, a.game);
    } else {
        auto game = openGame(a.game);
        stage.emplace(*game, a.map);
        files = std::move(game);
    }
    HeadlessEngine engine(*files);
    engine.showsMessages = false;
    engine.loadModule(findModule("null"));
    if (recording)
        loadTrace(engine, *recording);
    else
        stage->load(engine);
    // What the renderers look for by themselves: the sun, flares, the font of numbers on the picture.
    for (const char* name : {"sun", "flareShader", "gfx/2d/bigchars"})
        engine.enter([name](const refexport_t& module) { module.RegisterShader(name); });
    std::vector<std::pair<std::string, std::vector<std::byte>>> entries;
    for (const std::string& name : engine.filesRead())
        if (auto bytes = files->read(name)) entries.emplace_back(name, std::move(*bytes));
    engine.unloadModule();
    writePk3(output.temporary(), entries);
    std::error_code isDevice; // which keeps nothing
    uintmax_t size = fs::file_size(output.temporary(), isDevice);
    if (isDevice) size = 0;
    output.commit();
    if (a.json)
        std::printf("%s\n", toJsonText({{"archive", a.out}, {"files", entries.size()}, {"bytes", size}}).c_str());
    else
        std::printf("%s: %s, %.1f MB\n", a.out.c_str(), countOf(entries.size(), "file").c_str(),
                    static_cast<double>(size) / 1e6);
}

} // namespace

void addSubsetCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("subset", "Write the smallest pk3 that draws a map or a recording");
    const auto a = std::make_shared<SubsetArguments>();
    CLI::Option_group* what = command->add_option_group("what to draw");
    addMapOption(*what, a->map);
    what->add_option("--trace", a->trace, "Recording (.q3t)");
    what->require_option(1);
    command->add_option("--out", a->out, "Archive to write (.pk3)")->required();
    command->add_flag("--json", a->json, "Print the result as one JSON object");
    addGameOptions(*command, a->game);
    command->footer("Example: q3rt subset --map oa_dm1 --out oa_dm1_only.pk3");
    command->callback([a, &exitCode] {
        runSubset(*a);
        exitCode = 0;
    });
}

} // namespace q3rt
