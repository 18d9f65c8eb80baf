#pragma once
// `q3rt info --luxels`: how much of a map's baked light some lights explain, a row a map.

#include <string>

#include "scene/lights.hpp"

namespace q3rt {

void printLuxelHeader();
void printLuxels(const std::string& map, const World& world, const MaterialLibrary& materials, const LightSet& lights,
                 size_t count, bool json);

} // namespace q3rt
