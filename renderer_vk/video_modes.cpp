#include "renderer_vk/video_modes.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "engine/video_sizes.hpp"

namespace q3rt {

std::vector<std::string> describeVideoModes(const RasterSettings& settings) {
    std::vector<std::string> lines = {"Mode -2: the desktop's size",
                                      formatText("Mode -1: %dx%d (r_customwidth, "
                                                 "r_customheight)",
                                                 settings.r_customwidth, settings.r_customheight)};
    for (size_t i = 0; i < kVideoSizes.size(); ++i)
        lines.push_back(formatText("Mode %2zu: %dx%d", i, kVideoSizes[i].first, kVideoSizes[i].second));
    return lines;
}

std::optional<VideoMode> findVideoMode(const RasterSettings& settings, std::pair<int, int> desktop) {
    if (settings.r_mode == -2) return VideoMode{desktop.first, desktop.second, 1};
    if (settings.r_mode == -1)
        return VideoMode{std::max(settings.r_customwidth, 4), std::max(settings.r_customheight, 4),
                         settings.r_customPixelAspect > 0 ? settings.r_customPixelAspect : 1.0f};
    const auto index = static_cast<size_t>(settings.r_mode);
    if (settings.r_mode < 0 || index >= kVideoSizes.size()) return std::nullopt;
    return VideoMode{kVideoSizes[index].first, kVideoSizes[index].second, 1};
}

} // namespace q3rt
