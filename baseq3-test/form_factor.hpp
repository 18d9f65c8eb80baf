#pragma once
// How much of the hemisphere over a surface element a rectangle fills, weighted by the cosine: the closed form behind
// every expected value of the test maps.

#include <array>

#include "math/vector.hpp"

namespace q3rt {

using RectangleCorners = std::array<dvec3, 4>; ///< in order around the rectangle, any direction

/// Form factor [0, 1] from a surface element at `point` with unit `normal` to the rectangle, both sides of which emit:
/// Lambert's sum over the edges, angle times cosine, over 2 pi; what lies below the element's horizon is cut off first.
/// Irradiance below a surface light V is 0.75 V times this, in luxel units.
double rectangleFormFactor(const dvec3& point, const dvec3& normal, const RectangleCorners& corners);

} // namespace q3rt
