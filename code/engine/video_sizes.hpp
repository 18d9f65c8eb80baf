#pragma once
// r_mode 0 to 11, as the engine's menus number them.

#include <array>
#include <utility>

namespace q3rt {

/// Width and height in pixels.
inline constexpr std::array<std::pair<int, int>, 12> kVideoSizes = {{{320, 240},
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

} // namespace q3rt
