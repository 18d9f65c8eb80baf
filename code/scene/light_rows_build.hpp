#pragma once
// The parts of buildLightRows.

#include "scene/bsp_clip.hpp"
#include "scene/light_rows.hpp"

namespace q3rt {

/// By cluster; behind the last one the whole world.
std::vector<ClusterPoints> pickClusterPoints(const World& world, const MaterialLibrary& materials);

/// Where a row's points may be.
struct RowRegion {
    Bounds box;
    uint32_t normalClass = 0;
    const RowPoints* points = nullptr;
};

/// May any of the light reach any point of the region, as far as its own plane and the points' plane tell?
bool shinesToward(const RowLight& light, const RowRegion& region);

/// Weights for choosing one of the lights at random: what it gives without a shadow, mean over the region's points,
/// with a share by a bound of what it may give at any point of the region's box, and a little for every light.
std::vector<double> weighLights(std::span<const RowLight> lights, std::span<const uint32_t> list,
                                const RowRegion& region);

} // namespace q3rt
