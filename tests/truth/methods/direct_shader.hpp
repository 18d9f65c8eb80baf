#pragma once
// The direct stage of the ray tracer (shaders/rt/direct.glsl, lights.glsl, grid.glsl) compiled as C++, with its tables,
// random numbers and shadow rays given by the test.

#include <functional>
#include <vector>

#include "math/vector.hpp"
#include "shaders/shared/rt_scene.h"

namespace q3rt::test {

struct DirectInputs {
    RtFrame frame{};                                                        ///< addresses are C++ pointers
    std::function<glm::uvec4(uint dimension)> random;                       ///< 32 bits each
    std::function<bool(const vec3& origin, const vec3& direction)> visible; ///< is (0, 1) of the way free?
    std::function<bool(const vec3& origin, const vec3& direction)> sky;     ///< is what the way meets first a sky?
};

/// Dimension of the first choice's numbers: place on the light (x, y), which candidate (z), which of the row (w).
extern const uint kChoiceDimension;
/// Least weight of a sun's share in a choice.
extern const float kLeastSunShare;

/// Row of the light table whose lights the pixel tries.
RtLightRow rowOfPixel(DirectInputs& inputs, const RtPixel& pixel);

/// What one number draws from a row: a light, and 1 / its probability.
struct Drawn {
    uint light;
    float weight;
    float seen;
};
float chanceOfColumn(const RtLightEntry& entry);
Drawn drawFromRow(DirectInputs& inputs, const RtLightRow& row, uint bits);

/// Which of the candidates with these weights is kept by a random number.
size_t keptCandidate(const std::vector<double>& weights, float random);

/// L of one pixel: irradiance / 63.75 luxel units, with the ambient term. One run at a time.
vec3 runDirectStage(DirectInputs& inputs, const RtPixel& pixel);

/// A lit pixel at a point of a triangle, with the error that the primary stage would give it. Normals are unit and on
/// the side that is seen.
RtPixel makeLitPixel(const vec3 corner[3], const vec2& barycentric, const vec3& shadingNormal,
                     const vec3& geometricNormal);

/// Where its shadow rays start.
vec3 shadowOriginOf(const RtPixel& pixel);

} // namespace q3rt::test
