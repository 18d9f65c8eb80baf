#include "scene/lost_light_file.hpp"

#include "base/error.hpp"
#include "base/log.hpp"

namespace q3rt {
namespace {

std::string mapName(const World& world) {
    const size_t start = world.name.rfind('/') + 1; // npos + 1 = 0
    return world.name.substr(start, world.name.rfind('.') - start);
}

} // namespace

std::string lostLightFile(const World& world) { return "lights/" + mapName(world) + ".ent"; }

std::optional<LostLights> readLostLights(FileSource& files, const World& world) {
    const std::string name = lostLightFile(world), map = mapName(world);
    const auto bytes = files.read(name);
    if (!bytes) {
        logLine(LogLevel::Info,
                "no %s: light that the map lost is taken from its light grid; 'q3rt relight --map %s' "
                "recovers it",
                name.c_str(), map.c_str());
        return std::nullopt;
    }
    try {
        LostLights lights = parseLostLights({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, name);
        // A file written by hand need not name its bake.
        if (lights.lightmap.empty() || lights.lightmap == lightmapFingerprint(world.bsp)) return lights;
        logLine(LogLevel::Warning,
                "rt_lostLights: %s is of another bake of the map and is left out; 'q3rt relight --map %s' makes a "
                "new one",
                name.c_str(), map.c_str());
    } catch (const ContentError& damage) {
        logLine(LogLevel::Warning, "rt_lostLights: %s", damage.what());
    }
    return std::nullopt;
}

} // namespace q3rt
