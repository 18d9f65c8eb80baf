#pragma once
// How strong the lights that a map's scripts name were when it was baked: scripts change after a map is compiled, and
// some compilers had no sun. A quick estimate for maps without lights/MAP.ent, one factor for each kind of light, from
// how the lightmap differs between places that are near one another: bounces, lost lights and light that is everywhere
// are nearly the same there, and what a light gives is not.

#include <string>
#include <vector>

#include "renderer_rt/light_probe.hpp"

namespace q3rt {

/// Lights that share their strength.
struct BakedStrength {
    std::string name; ///< material, "sun N" or "entities"
    float factor = 1; ///< of what the scripts say; 0: the bake had none of it
};

/// Of all kinds that the lights are of. Deterministic. The lights stay as they are.
std::vector<BakedStrength> estimateStrengths(const World& world, const MaterialLibrary& materials,
                                             const TextureLibrary& textures, const ProbeGeometry& geometry,
                                             const LightSet& lights);

/// Multiplies each light by its kind's factor; what becomes dark is no light any more.
void applyStrengths(const std::vector<BakedStrength>& strengths, const World& world, const MaterialLibrary& materials,
                    LightSet& lights);

} // namespace q3rt
