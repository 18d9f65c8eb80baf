#pragma once
// Where a light should move: a Gauss-Newton step (damped as by Levenberg 1944) on 7500 V cos / d^2 over the receivers
// that see it, with shadows frozen, for its place and its strength together.

#include "relight/point_search.hpp"

namespace q3rt {

/// Zero if it should stay, or if the way there is blocked.
vec3 moveOf(const LightScene& scene, const LightFit& fit, const FoundLight& light);

} // namespace q3rt
