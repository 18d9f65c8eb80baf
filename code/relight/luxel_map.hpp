#pragma once
// A map's luxels with their places in the world, gathered into patches: small where the light changes, large where it
// does not. Patches are what the fit looks at and what light bounces between.

#include <vector>

#include "scene/world.hpp"

namespace q3rt {

/// One lightmap texel whose centre lies on a triangle.
struct PlacedLuxel {
    vec3 position{0}, normal{0}; ///< on the surface; unit
    uint32_t texel = 0;          ///< page x 128 x 128 + row x 128 + column
    float areaQu2 = 0;
};

struct LuxelPatch {
    vec3 position{0}, normal{0}; ///< means over its luxels; normal unit
    vec3 baked{0};               ///< mean, luxel units
    vec3 albedo{0};              ///< mean colour of the material's texture, as the map compilers bounce light
    float areaQu2 = 0;
    uint32_t firstLuxel = 0, luxelCount = 0; ///< in LuxelMap::luxels
    int surface = -1;
    bool saturated = false; ///< half of it or more has no headroom left: the light was at least this
};

struct LuxelMapSettings {
    size_t patchCount = 16384; ///< at most; fewer where the light is even
    unsigned heldOutOneIn = 8;
};

struct LuxelMap {
    std::vector<PlacedLuxel> luxels; ///< by patch
    std::vector<LuxelPatch> patches;
    std::vector<int> patchOfTexel; ///< -1: no luxel of the world near
    const World* world = nullptr;

    vec3 bakedAt(const PlacedLuxel& luxel) const;
    /// Patch at a point of a triangle given by its first index; -1 none.
    int patchAt(uint32_t surface, uint32_t firstIndex, const vec2& barycentric) const;
};

/// Luxels that no fit sees.
bool isHeldOut(uint32_t texel, unsigned oneIn);

/// How far off the face map compilers put their sample, qu.
inline constexpr float kSampleOffsetQu = 1.0f;

/// Luxels of the world model's lit faces; those inside solid are left out.
LuxelMap buildLuxelMap(const World& world, const MaterialLibrary& materials, const LuxelMapSettings& settings);

} // namespace q3rt
