#pragma once
// Window sizes by r_mode (spec of models, section 9).

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer_vk/raster_settings.hpp"

namespace q3rt {

struct VideoMode {
    int width = 640, height = 480; ///< pixels
    float pixelAspect = 1;
    float windowAspect() const { return static_cast<float>(width) / (static_cast<float>(height) * pixelAspect); }
};

/// The mode of r_mode; `desktop` is the size for mode -2. Nullopt: there is no such mode.
std::optional<VideoMode> findVideoMode(const RasterSettings& settings, std::pair<int, int> desktop);

/// A line a mode, for people.
std::vector<std::string> describeVideoModes(const RasterSettings& settings);

/// What the original falls back to.
inline constexpr VideoMode kFallbackMode{640, 480, 1};

} // namespace q3rt
