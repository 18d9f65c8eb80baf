// q3rt relight: the light that a map lost, recovered from its lightmap (docs/lost_light.md).

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/commands/commands.hpp"
#include "host/common/json_text.hpp"
#include "host/common/option_checks.hpp"
#include "host/inspect/lost_light_files.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

struct RelightArguments {
    std::string map, out;
    RelightSettings settings;
    GameChoice game;
    bool all = false, again = false, json = false;
};

nlohmann::ordered_json toJson(const LightScore& score) {
    return {{"correlation", score.correlation},
            {"median_relative_error", score.medianRelativeError},
            {"explained_share", score.explainedShare},
            {"mean_traced", score.meanTraced},
            {"mean_baked", score.meanBaked}};
}

nlohmann::ordered_json toJson(const std::string& map, const RelightOutcome& outcome) {
    const RelightResult& r = outcome.result;
    nlohmann::ordered_json line = {{"map", map},
                                   {"file", outcome.file.string()},
                                   {"lights", r.lights.points.size()},
                                   {"suns", r.lights.suns.size()},
                                   {"bounce", r.lights.bounce},
                                   {"ambient", r.lights.ambientValue},
                                   {"luxels", r.luxelCount},
                                   {"patches", r.patchCount},
                                   {"shown_share", r.shownShare},
                                   {"scored_luxels", r.after.count},
                                   {"before", toJson(r.before)},
                                   {"after", toJson(r.after)},
                                   {"wall_s", outcome.wallSeconds},
                                   {"processor_s", outcome.processorSeconds}};
    auto& curve = line["curve"] = nlohmann::ordered_json::array();
    for (const RelightStage& stage : r.stages)
        curve.push_back({{"lights", stage.points},
                         {"correlation", stage.score.correlation},
                         {"explained_share", stage.score.explainedShare}});
    if (outcome.truth)
        line["truth"] = {{"lights", outcome.truth->sourceLights},
                         {"energy", outcome.truth->sourceEnergy},
                         {"found_energy", outcome.truth->foundEnergy},
                         {"matched_share", outcome.truth->matchedShare},
                         {"near_share", outcome.truth->nearShare}};
    return line;
}

void printOutcome(const std::string& map, const RelightOutcome& outcome, bool json) {
    if (json) {
        std::printf("%s\n", toJsonText(toJson(map, outcome)).c_str());
    } else {
        const RelightResult& r = outcome.result;
        std::printf("%-18s %4zu lights, %zu suns; held-out luxels: correlation %.3f (was %.3f), median error %.0f %% "
                    "(was %.0f %%), mean %.1f of %.1f; %.0f s\n",
                    map.c_str(), r.lights.points.size(), r.lights.suns.size(), r.after.correlation,
                    r.before.correlation, 100 * r.after.medianRelativeError, 100 * r.before.medianRelativeError,
                    r.after.meanTraced, r.after.meanBaked, outcome.wallSeconds);
        if (outcome.truth)
            std::printf("%-18s source: %zu lights, %.0f %% of their energy matched, %.0f %% of what was found is near "
                        "one of them\n",
                        "", outcome.truth->sourceLights, 100 * outcome.truth->matchedShare,
                        100 * outcome.truth->nearShare);
        std::printf("%-18s %s\n", "", outcome.file.c_str());
    }
    std::fflush(stdout);
}

/// Every map that has no finished file yet. A map that can't be done does not stop the others.
void relightAll(Pk3FileSource& files, const RelightArguments& a, const fs::path& folder) {
    const std::vector<std::string> maps = files.list("maps", ".bsp");
    size_t failed = 0;
    for (size_t i = 0; i < maps.size(); ++i) {
        const RelightJob job{maps[i].substr(0, maps[i].size() - 4), folder, a.settings};
        try {
            if (!a.again && hasLostLights(files, job)) continue;
            std::fprintf(stderr, "map %zu of %zu\n", i + 1, maps.size());
            printOutcome(job.map, runRelight(files, job), a.json);
        } catch (const ContentError& error) {
            std::fprintf(stderr, "q3rt: %s\n", error.what());
            ++failed;
        }
    }
    if (failed > 0)
        throw ContentError(formatText("%zu of %zu maps have no file in %s; the lines above say why", failed,
                                      maps.size(), folder.c_str()));
}

void runRelightCommand(const RelightArguments& a) {
    const auto files = openGame(a.game);
    const fs::path folder = a.out.empty() ? lostLightFolder(a.game) : fs::path(a.out);
    if (a.all)
        relightAll(*files, a, folder);
    else
        printOutcome(a.map, runRelight(*files, {a.map, folder, a.settings}), a.json);
}

} // namespace

void addRelightCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand(
        "relight", "Recover the light that a map lost from its lightmap, as text for the ray tracer and for editors");
    const auto a = std::make_shared<RelightArguments>();
    const auto which = command->add_option_group("maps");
    addMapOption(*which, a->map);
    which->add_flag("--all", a->all, "Every map of the game that has no file yet; goes on where it was broken off");
    which->require_option(1);
    command->add_flag("--again", a->again, "With --all: also the maps that have a file");
    command->add_option("--budget", a->settings.budget, "Point and spot lights at most, up to 100000")
        ->check(wholeNumber(0, 100'000))
        ->capture_default_str();
    command->add_option("--out", a->out, "Folder for MAP.ent (default: lights/ in q3rt's home folder of the game)")
        ->type_name("DIR");
    addGameOptions(*command, a->game);
    command->add_flag("--json", a->json, "One JSON object a map instead of text");
    command->footer("Example: q3rt relight --map oa_dm1");
    command->callback([a, &exitCode] {
        runRelightCommand(*a);
        exitCode = 0;
    });
}

} // namespace q3rt
