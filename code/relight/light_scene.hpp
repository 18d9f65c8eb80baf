#pragma once
// What the fit of lights works on: the map, what stops light in it, its luxels, and the kinds of light that its scripts
// name.

#include <string>
#include <vector>

#include "relight/luxel_map.hpp"
#include "relight/open_space.hpp"
#include "scene/lights.hpp"

namespace q3rt {

/// A place where light is counted: a patch, or one luxel. Mean over a few points of it.
struct LightReceiver {
    static constexpr int kPoints = 4;
    vec3 position[kPoints]; ///< off the surface by kSampleOffsetQu
    vec3 normal[kPoints];
    int cluster = -1; ///< of the first point
};

/// Light that one script gives. Strengths are fitted a kind.
struct EmitterKind {
    enum class Type { Surface, Sky, SkyDome }; ///< SkyDome: q3map_skylight
    Type type = Type::Surface;
    std::string material;            ///< whose script names it
    vec3 color{1};                   ///< largest component 1
    float radiosity = 0;             ///< luxel units as the script has it; 0: a sky whose script gives none
    std::vector<uint32_t> triangles; ///< in LightSet::triangles
};

struct LightScene {
    LightScene(const World& world, const MaterialLibrary& materials, const LuxelMapSettings& settings,
               size_t openPointCount);

    const World& world;
    const MaterialLibrary& materials;
    LightSet lights; ///< as the scripts have them
    LightOccluders occluders;
    OpenSpace open;
    LuxelMap luxels;
    std::vector<EmitterKind> kinds;
    std::vector<int> skyKindOfSurface;    ///< index in kinds of type Sky; -1 none
    std::vector<LightReceiver> receivers; ///< of the patches

    /// Does a ray in this direction meet the lit side?
    bool isFront(const OccluderHit& hit, const vec3& direction) const;
    /// May anything in one cluster see anything in the other? -1 sees all.
    bool mayMeet(int a, int b) const { return world.bsp.clusterVisible(a, b) || world.bsp.clusterVisible(b, a); }
    /// A luxel as a receiver: points within its square.
    LightReceiver receiverOf(const PlacedLuxel& luxel) const;

  private:
    LightReceiver receiverOf(const LuxelPatch& patch) const;
};

inline float largestOf(const vec3& v) { return glm::max(v.x, glm::max(v.y, v.z)); }

} // namespace q3rt
