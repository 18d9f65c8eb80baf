#include "scene/lost_light_file.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"

namespace q3rt {
namespace {

std::string fileOf(const std::string& map) { return "lights/" + map + ".ent"; }

/// None if it isn't there, doesn't hold `mention`, or is damaged: a line says that.
std::optional<LostLights> parseFile(FileSource& files, const std::string& name, std::string_view mention) {
    const auto bytes = files.read(name);
    if (!bytes) return std::nullopt;
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    if (text.find(mention) == std::string_view::npos) return std::nullopt;
    try {
        return parseLostLights(text, name);
    } catch (const ContentError& damage) {
        logLine(LogLevel::Warning, "rt_lostLights: %s", damage.what());
        return std::nullopt;
    }
}

/// All files of recovered lights, first those whose names begin as the map's does: renamed copies do.
std::vector<std::string> filesByLikeness(FileSource& files, const std::string& map) {
    std::vector<std::string> names = files.list("lights", ".ent");
    const auto unlike = [&](const std::string& name) { return map.end() - std::ranges::mismatch(map, name).in1; };
    std::ranges::sort(names, [&](const std::string& a, const std::string& b) {
        return std::pair(unlike(a), std::cref(a).get()) < std::pair(unlike(b), std::cref(b).get());
    });
    return names;
}

} // namespace

std::string mapName(const World& world) {
    const size_t start = world.name.rfind('/') + 1; // npos + 1 = 0
    return world.name.substr(start, world.name.rfind('.') - start);
}

std::optional<FoundLights> findLostLights(FileSource& files, const Bsp& bsp, const std::string& map) {
    const std::string own = fileOf(map), lightmap = lightmapFingerprint(bsp);
    auto lights = parseFile(files, own, "");
    // A file written by hand need not name its bake.
    if (lights && (lights->lightmap.empty() || lights->lightmap == lightmap))
        return FoundLights{own, std::move(*lights)};
    if (!bsp.lightmaps.empty()) // else its fingerprint is that of many maps
        for (const std::string& name : filesByLikeness(files, map))
            if (auto twin = parseFile(files, "lights/" + name, lightmap); twin && twin->lightmap == lightmap)
                return FoundLights{"lights/" + name, std::move(*twin)};
    if (lights)
        logLine(LogLevel::Warning,
                "rt_lostLights: %s is of another bake of the map and is left out; 'q3rt relight --map %s' makes a "
                "new one",
                own.c_str(), map.c_str());
    return std::nullopt;
}

std::optional<LostLights> readLostLights(FileSource& files, const World& world) {
    const std::string map = mapName(world), own = fileOf(map);
    if (auto found = findLostLights(files, world.bsp, map)) {
        if (found->file != own)
            logLine(LogLevel::Info, "%s is of a map with the same lightmap: its lights are this map's",
                    found->file.c_str());
        return std::move(found->lights);
    }
    if (!files.read(own))
        logLine(LogLevel::Info,
                "no %s: light that the map lost is taken from its light grid; 'q3rt relight --map %s' recovers it",
                own.c_str(), map.c_str());
    return std::nullopt;
}

} // namespace q3rt
