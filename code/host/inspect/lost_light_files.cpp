#include "host/inspect/lost_light_files.hpp"

#include <chrono>
#include <ctime>
#include <span>

#include "base/error.hpp"
#include "base/log.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/output_file.hpp"
#include "host/common/progress.hpp"
#include "scene/lost_light_file.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

std::string_view asText(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Lights of this bake; a damaged file is named and counts as none.
std::optional<LostLights> parseIfCurrent(const std::vector<std::byte>& bytes, const std::string& name,
                                         const std::string& lightmap) {
    try {
        LostLights lights = parseLostLights(asText(bytes), name);
        if (lights.lightmap == lightmap) return lights;
    } catch (const ContentError& damage) {
        logLine(LogLevel::Warning, "%s; it is made anew", damage.what());
    }
    return std::nullopt;
}

std::optional<LostLights> readLights(const fs::path& file, const std::string& lightmap) {
    if (!fs::exists(file)) return std::nullopt;
    return parseIfCurrent(readFileBytes(file), file.string(), lightmap);
}

void writeLights(const fs::path& file, const LostLights& lights, const std::string& map) {
    const std::string text = formatLostLights(lights, map);
    writeFileBytes(file, std::as_bytes(std::span(text)));
}

fs::path fileOf(const RelightJob& job) { return job.folder / (job.map + ".ent"); }

void sayIfTwinServes(FileSource& files, const World& world) {
    const std::string map = mapName(world);
    const auto found = findLostLights(files, world.bsp, map);
    if (found && found->file != "lights/" + map + ".ent")
        logLine(LogLevel::Info, "%s is of a map with the same lightmap and serves %s without a file of its own",
                found->file.c_str(), map.c_str());
}

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

} // namespace

fs::path lostLightFolder(const GameChoice& game) {
    cacheFolder(); // says what is wrong with it
    return findInstallation(game).lightFolders.back();
}

bool hasLostLights(Pk3FileSource& files, const RelightJob& job) {
    const std::string name = "maps/" + job.map + ".bsp";
    const auto lights = readLights(fileOf(job), lightmapFingerprint(parseBsp(readMap(files, job.map), name)));
    return lights && lights->stage == 0;
}

void ensureLostLights(Pk3FileSource& files, const GameChoice& game, const std::string& map) {
    if (findLostLights(files, parseBsp(readMap(files, map), "maps/" + map + ".bsp"), map)) return;
    runRelight(files, {map, lostLightFolder(game), {}});
}

RelightOutcome runRelight(Pk3FileSource& files, const RelightJob& job) {
    const std::string name = "maps/" + job.map + ".bsp";
    readMap(files, job.map); // says what is wrong with it
    RelightOutcome outcome;
    outcome.file = fileOf(job);
    fs::path part = outcome.file;
    part += ".part";
    checkWritable(outcome.file);
    TextureLibrary textures(files, TextureSettings{});
    MaterialLibrary materials(files, textures, MaterialSettings{});
    const auto world = loadWorld(files, name, materials, WorldSettings{});
    sayIfTwinServes(files, *world);
    const auto start = std::chrono::steady_clock::now();
    const double processorStart = processorSeconds();

    std::optional<LostLights> begun = readLights(part, lightmapFingerprint(world->bsp));
    if (begun && (begun->stage == 0 || begun->budget != job.settings.budget)) begun.reset();
    std::unique_ptr<Progress> progress;
    RelightProgress watcher;
    watcher.step = [&](size_t done, size_t all) {
        if (!progress) progress = std::make_unique<Progress>(job.map + ": step", all);
        progress->advance(done);
    };
    watcher.stage = [&](const LostLights& lights) { writeLights(part, lights, job.map); };
    outcome.result = relight(*world, materials, job.settings, begun ? &*begun : nullptr, watcher);
    if (outcome.result.luxelCount == 0)
        throw ContentError(name + " has no lightmap, so there is no light to learn from; draw it without a file");
    writeLights(outcome.file, outcome.result.lights, job.map);
    std::error_code ignored; // without a folder of its own it may not be there
    fs::remove(part, ignored);
    outcome.wallSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.processorSeconds = processorSeconds() - processorStart;
    if (const auto source = files.read("sources/maps/" + job.map + ".map"))
        outcome.truth = compareWithTruth(parseMapSourceLights(asText(*source)), outcome.result.lights.points);
    return outcome;
}

} // namespace q3rt
