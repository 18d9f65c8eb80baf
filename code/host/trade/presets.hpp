#pragma once
// Presets and levels from a sweep: the text of renderer_rt/presets.def.h. Pure.

#include <span>
#include <string>

#include "host/trade/result.hpp"

namespace q3rt {

/// `title` says what was measured on what, `command` by which command line. Presets are points of the front
/// from SSIM 0.97 on, or of all of it if none is so near: the most accurate that is as fast as its fastest (within that
/// one's upper quartile), the most accurate of all, and the most accurate within the first and the second third of the
/// logarithm of time between them. Levels are the front of the
/// points with denoiser, TAA, the best culling and a number of lights, which differ in lights, depth and scale alone: a
/// renderer can change these from frame to frame. Throws UsageError if the sweep has none of those, or points of
/// several sizes.
std::string formatPresets(std::span<const TradeResult> results, TradeClock clock, const std::string& title,
                          const std::string& command);

} // namespace q3rt
