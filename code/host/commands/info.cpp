// q3rt info: what a map holds and requires.

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/commands/commands.hpp"
#include "host/common/json_text.hpp"
#include "host/common/option_checks.hpp"
#include "host/common/progress.hpp"
#include "host/common/session.hpp"
#include "host/inspect/census.hpp"
#include "host/inspect/luxel_table.hpp"
#include "scene/lost_light_file.hpp"

namespace q3rt {

namespace {

struct InfoArguments {
    std::string map;
    GameChoice game;
    bool all = false, json = false, luxels = false, recovered = false;
    size_t luxelCount = 3000;
};

nlohmann::ordered_json toJson(const MapCensus& census) {
    return {{"map", census.map},
            {"faces",
             {{"planar", census.planarFaces},
              {"patch", census.patches},
              {"triangle_soup", census.triangleSoups},
              {"flare", census.flares},
              {"hidden_patches", census.hiddenPatches},
              {"drawn", census.drawnFaces}}},
            {"triangles", {{"drawn", census.drawnTriangles}, {"zero_area", census.zeroAreaTriangles}}},
            {"vertices", census.vertices},
            {"brush_models", census.brushModels},
            {"materials", {{"used", census.materials}, {"missing", census.missingMaterials}}},
            {"clusters", census.clusters},
            {"lightmap_pages", census.lightmapPages},
            {"light_grid", census.lightGrid},
            {"fog_volumes", census.fogVolumes},
            {"entities", census.entities},
            {"spawn_points", census.spawnPoints},
            {"size_qu", {census.sizeQu.x, census.sizeQu.y, census.sizeQu.z}},
            {"lights",
             {{"emissive_faces", census.emissiveFaces},
              {"triangles", census.triangleLights},
              {"triangles_seen_by_a_cluster", census.meanVisibleLights},
              {"suns", census.suns},
              {"skies", census.skyLights},
              {"points", census.pointLights}}},
            {"requires", census.requirements}};
}

void printText(const MapCensus& c) {
    std::printf("%s: %.0f x %.0f x %.0f units\n", c.map.c_str(), double(c.sizeQu.x), double(c.sizeQu.y),
                double(c.sizeQu.z));
    std::printf("faces      %zu planar, %zu patches (%zu hidden), %zu triangle soups, %zu flares; %zu drawn\n",
                c.planarFaces, c.patches, c.hiddenPatches, c.triangleSoups, c.flares, c.drawnFaces);
    std::printf("triangles  %zu drawn (%zu of no area), %zu vertices\n", c.drawnTriangles, c.zeroAreaTriangles,
                c.vertices);
    std::printf("models     %zu brush models; %zu entities, %zu spawn points\n", c.brushModels, c.entities,
                c.spawnPoints);
    std::printf("materials  %zu used, %zu missing\n", c.materials, c.missingMaterials);
    std::printf("light      %zu lightmap pages, light grid %s\n", c.lightmapPages, c.lightGrid ? "present" : "absent");
    std::printf(
        "lights     %zu triangles of %zu emissive faces (a cluster sees %.1f), %zu suns, %zu skies, %zu points\n",
        c.triangleLights, c.emissiveFaces, c.meanVisibleLights, c.suns, c.skyLights, c.pointLights);
    std::printf("visibility %zu clusters; %zu fog volumes\n", c.clusters, c.fogVolumes);
    std::printf("requires  ");
    for (const auto& [what, count] : c.requirements)
        std::printf("%s %s (%zu)", &what == &c.requirements.begin()->first ? "" : ",", what.c_str(), count);
    std::printf("%s\n", c.requirements.empty() ? " nothing beyond opaque lit surfaces" : "");
}

void printMap(Pk3FileSource& files, const std::string& map, const InfoArguments& arguments) {
    readMap(files, map); // says what is wrong with it
    TextureLibrary textures(files, TextureSettings{});
    MaterialLibrary materials(files, textures, MaterialSettings{});
    const auto world = loadWorld(files, "maps/" + map + ".bsp", materials, WorldSettings{});
    if (arguments.luxels) {
        LightSet lights = extractLights(*world, materials);
        const auto lost = arguments.recovered ? readLostLights(files, *world) : std::nullopt;
        if (lost) applyLostLights(*lost, *world, materials, lights);
        printLuxels(map, *world, materials, lights, arguments.luxelCount, arguments.json);
        return;
    }
    const MapCensus census = takeCensus(*world, materials);
    if (arguments.json)
        std::printf("%s\n", toJsonText(toJson(census)).c_str());
    else
        printText(census);
}

void runInfo(const InfoArguments& arguments) {
    const auto files = openGame(arguments.game);
    if (arguments.luxels && !arguments.json) printLuxelHeader();
    if (!arguments.all) {
        printMap(*files, arguments.map, arguments);
        return;
    }
    const std::vector<std::string> maps = files->list("maps", ".bsp");
    Progress progress("map", maps.size());
    size_t failed = 0;
    for (size_t i = 0; i < maps.size(); ++i) {
        try {
            printMap(*files, maps[i].substr(0, maps[i].size() - 4), arguments);
        } catch (const ContentError& error) {
            std::fprintf(stderr, "q3rt: %s\n", error.what());
            ++failed;
        }
        progress.advance(i + 1);
    }
    if (failed > 0)
        throw ContentError(
            formatText("%zu of %zu maps can't be counted; the lines above say why", failed, maps.size()));
}

} // namespace

void addInfoCommand(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand(
        "info", "Count what a map holds (faces, triangles, lights, clusters) and say what it requires of a renderer");
    const auto arguments = std::make_shared<InfoArguments>();
    const auto which = command->add_option_group("maps");
    addMapOption(*which, arguments->map);
    which->add_flag("--all", arguments->all, "Every map of the game, one after the other");
    which->require_option(1);
    command->add_flag("--luxels", arguments->luxels,
                      "Compare the light of the lights found with the baked lightmap instead (docs/lights.md)");
    command
        ->add_flag("--recovered", arguments->recovered,
                   "With --luxels: with the light of lights/MAP.ent, if it is there")
        ->needs("--luxels");
    command->add_option("--points", arguments->luxelCount, "Luxels compared a map, 10 to 10000000 (default 3000)")
        ->check(wholeNumber(10, 10'000'000));
    addGameOptions(*command, arguments->game);
    command->add_flag("--json", arguments->json, "One JSON object a map instead of text");
    command->footer("Example: q3rt info --map oa_dm1 --json");
    command->callback([arguments, &exitCode] {
        runInfo(*arguments);
        exitCode = 0;
    });
}

} // namespace q3rt
