#pragma once
// Dither masks whose error has no low frequencies, by the void-and-cluster method (Ulichney 1993, "The Void-and-Cluster
// Method for Dither Array Generation"). Runs at build time.

#include <cstdint>
#include <vector>

namespace q3rt {

/// Ranks 0 to side^2 - 1, each once, row by row; the mask tiles. The same seed gives the same mask.
std::vector<uint16_t> makeBlueNoise(uint32_t side, uint32_t seed);

} // namespace q3rt
