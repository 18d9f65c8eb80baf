#pragma once
// Converged pictures with what they don't know: each is a mean of independent pictures (seeds of their own), from which
// the standard error of every pixel comes.

#include <vector>

#include "tracer/trace_harness.hpp"

namespace q3rt::test {

struct MeasuredPicture {
    int width = 0, height = 0;
    std::vector<dvec3> mean;     ///< radiance, row by row from the top
    std::vector<dvec3> variance; ///< of the mean
};

/// `seeds` pictures of `frames` frames each, starting at `firstSeed`. rt_accumulate must be 1.
MeasuredPicture measurePicture(TraceHarness& harness, const Camera& camera, int seeds, int frames, int firstSeed = 1);

/// Differences of two pictures on tiles of 8 x 8 pixels in units of their standard error. Pixels are independent: a
/// tile's variance is the sum over its pixels, known from 64 (seeds - 1) degrees of freedom.
struct TileComparison {
    size_t tiles = 0, beyond = 0; ///< tiles whose sum differs by more than 4 standard errors
    double worst = 0;             ///< standard errors
    double luminanceRatio = 0;    ///< of the whole pictures, second / first
    double luminanceError = 0;    ///< standard error of that ratio
};
TileComparison compareTiles(const MeasuredPicture& first, const MeasuredPicture& second);

/// The map of `harness` with these settings, and the ones that every comparison wants: means of frames, no ambient
/// term.
void prepareHarness(TraceHarness& harness, const std::string& map,
                    const std::vector<std::pair<std::string, std::string>>& settings);

/// Unit direction of the ray through a point of the picture, in pixels; (0.5, 0.5) is the middle of the first one.
dvec3 rayDirection(const Camera& camera, int width, int height, double x, double y);

} // namespace q3rt::test
