#pragma once
// Directions from which light comes through the skies from afar: suns that a script had when the map was baked.

#include <optional>

#include "relight/light_fit.hpp"

namespace q3rt {

/// The direction that explains most of what is left, if that is `leastGain` of the fit's cost. Without a sky: none.
std::optional<vec3> findSun(const LightScene& scene, const LightFit& fit, double leastGain);

} // namespace q3rt
