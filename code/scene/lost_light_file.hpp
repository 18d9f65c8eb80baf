#pragma once
// lights/MAP.ent of the game's file system: the light that a map lost (docs/lost_light.md).

#include "base/file_source.hpp"
#include "scene/lost_lights.hpp"

namespace q3rt {

/// lights/oa_dm1.ent for maps/oa_dm1.bsp.
std::string lostLightFile(const World& world);

/// The file's lights. None if it isn't there (a hint says how it is made), is damaged or belongs to another bake of the
/// map: a line says so.
std::optional<LostLights> readLostLights(FileSource& files, const World& world);

} // namespace q3rt
