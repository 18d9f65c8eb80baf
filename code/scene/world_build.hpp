#pragma once
// The steps of loadWorld, each over the whole map. Order matters: materials need the lightmaps, marks need the patches.

#include "scene/patch.hpp"
#include "scene/world.hpp"

namespace q3rt {

/// What all steps share while one map is loaded.
struct WorldBuild {
    World& world;
    MaterialLibrary& materials;
    const WorldSettings& settings;
    int colorShift = 0; ///< overbright shift of baked light
};

/// Surfaces, vertices, indices and patches, with materials.
void buildSurfaces(const WorldBuild& build);
/// Fog volumes with their colours.
void buildFogs(const WorldBuild& build);

/// Keys of the first entity that the renderer obeys.
struct WorldspawnKeys {
    vec3 gridCellSize{64, 64, 128};                          ///< qu
    std::vector<std::pair<std::string, std::string>> remaps; ///< shader names: from, to
};
WorldspawnKeys readWorldspawn(const std::vector<MapEntity>& entities, bool vertexLight);

} // namespace q3rt
