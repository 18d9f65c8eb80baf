#include "renderer_vk/video_modes.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"

namespace q3rt {

namespace {

constexpr std::array<std::pair<int, int>, 12> kSizes = {{{320, 240},
                                                         {400, 300},
                                                         {512, 384},
                                                         {640, 480},
                                                         {800, 600},
                                                         {960, 720},
                                                         {1024, 768},
                                                         {1152, 864},
                                                         {1280, 1024},
                                                         {1600, 1200},
                                                         {2048, 1536},
                                                         {856, 480}}};

} // namespace

std::vector<std::string> describeVideoModes(const RasterSettings& settings) {
    std::vector<std::string> lines = {"Mode -2: the desktop's size",
                                      formatText("Mode -1: %dx%d (r_customwidth, "
                                                 "r_customheight)",
                                                 settings.r_customwidth, settings.r_customheight)};
    for (size_t i = 0; i < kSizes.size(); ++i)
        lines.push_back(formatText("Mode %2zu: %dx%d", i, kSizes[i].first, kSizes[i].second));
    return lines;
}

std::optional<VideoMode> findVideoMode(const RasterSettings& settings, std::pair<int, int> desktop) {
    if (settings.r_mode == -2) return VideoMode{desktop.first, desktop.second, 1};
    if (settings.r_mode == -1)
        return VideoMode{std::max(settings.r_customwidth, 4), std::max(settings.r_customheight, 4),
                         settings.r_customPixelAspect > 0 ? settings.r_customPixelAspect : 1.0f};
    const auto index = static_cast<size_t>(settings.r_mode);
    if (settings.r_mode < 0 || index >= kSizes.size()) return std::nullopt;
    return VideoMode{kSizes[index].first, kSizes[index].second, 1};
}

} // namespace q3rt
