#pragma once
// A map as it stands before anyone plays: inline models with movers at rest, portal surfaces, spawn points. What game
// code would tell a renderer, worked out from the entity lump.

#include <string>
#include <vector>

#include "abi/ref_types.h"
#include "formats/bsp.hpp"
#include "formats/entities.hpp"

namespace q3rt {

/// One entity to draw; the model's name is registered by whoever draws it.
struct StillEntity {
    std::string model; ///< "*3", "models/x.md3"; empty for portal surfaces
    refEntity_t entity{};
};

struct EyePoint {
    vec3 origin{0};
    float pitchDegrees = 0; ///< positive looks down
    float yawDegrees = 0;
};

std::vector<StillEntity> buildStillScene(const Bsp& bsp, const std::vector<MapEntity>& entities);
/// Player starts, seen from a standing player's eyes: info_player_deathmatch in the order of the entity lump; on maps
/// that have none, their other starts and then those of teams.
std::vector<EyePoint> findSpawnPoints(const std::vector<MapEntity>& entities);
/// The scene's view from an eye, all areas visible.
refdef_t makeView(const EyePoint& eye, float fovXDegrees, int width, int height, int timeMs);

} // namespace q3rt
