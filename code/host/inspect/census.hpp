#pragma once
// What a map holds and what it asks of a renderer: counts, by kind. No Vulkan.

#include <map>
#include <string>

#include "scene/light_rows.hpp"
#include "scene/world.hpp"

namespace q3rt {

struct MapCensus {
    std::string map;
    size_t planarFaces = 0, patches = 0, triangleSoups = 0, flares = 0; ///< records of the file, by type
    size_t hiddenPatches = 0;                                           ///< SURF_NODRAW: no geometry
    size_t drawnFaces = 0, drawnTriangles = 0, zeroAreaTriangles = 0;   ///< patches at full resolution
    size_t vertices = 0, brushModels = 0, materials = 0, missingMaterials = 0;
    size_t clusters = 0, lightmapPages = 0, fogVolumes = 0, entities = 0, spawnPoints = 0;
    bool lightGrid = false;
    vec3 sizeQu{0}; ///< of the drawn vertices
    size_t emissiveFaces = 0, triangleLights = 0, suns = 0, skyLights = 0, pointLights = 0;
    double meanVisibleLights = 0; ///< triangle and point lights that a cluster may see, mean over clusters
    /// What a renderer needs for this map -> drawn faces (or lights, entities) that need it; only what is there.
    std::map<std::string, size_t> requirements;
};

MapCensus takeCensus(const World& world, const MaterialLibrary& materials);

} // namespace q3rt
