#pragma once
// lights/MAP.ent of the game's file system: the light that a map lost (docs/lost_light.md).

#include "base/file_source.hpp"
#include "scene/lost_lights.hpp"

namespace q3rt {

struct FoundLights {
    std::string file; ///< lights/MAP.ent, or that of a map with the same lightmap
    LostLights lights;
};

/// The map's own file, or, where it has none of this bake, the first whose `_lightmap` is its lightmap: a renamed copy
/// of a map is lit as the map is. Of a file that is damaged, or of another bake and without a twin, a line says so.
std::optional<FoundLights> findLostLights(FileSource& files, const Bsp& bsp, const std::string& map);

/// The same for a world. If there is none, a line says how it is made.
std::optional<LostLights> readLostLights(FileSource& files, const World& world);

/// oa_dm1 of maps/oa_dm1.bsp.
std::string mapName(const World& world);

} // namespace q3rt
