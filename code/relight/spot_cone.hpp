#pragma once
// The cone around a point light that gains most: turned and widened step by step. Shadows do not depend on it, so no
// ray is traced.

#include "relight/light_fit.hpp"

namespace q3rt {

struct FittedCone {
    LightCone cone;
    double gain = 0; ///< off the fit's cost
};
/// `column`: of the light without a cone, which is not in the fit.
FittedCone fitCone(const LightScene& scene, const LightFit& fit, const vec3& origin, const LightColumn& column,
                   const vec3& axis, double price);

} // namespace q3rt
