#pragma once
// `q3rt info --luxels`: how much of a map's baked light its extracted lights explain, a row a map.

#include <string>

#include "scene/world.hpp"

namespace q3rt {

void printLuxelHeader();
void printLuxels(const std::string& map, const World& world, const MaterialLibrary& materials, size_t count, bool json);

} // namespace q3rt
