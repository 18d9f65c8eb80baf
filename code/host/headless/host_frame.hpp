#pragma once
// A picture that a module gave.

#include <cstdint>
#include <span>
#include <vector>

namespace q3rt {

/// 8-bit RGB, top row first.
struct HostFrame {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;
};

/// Of the engine's raw video: rows of BGR, bottom row first, each padded to 4 bytes. Width 0: the bytes are too few or
/// too many for one of this size.
HostFrame frameFromVideo(int width, int height, std::span<const uint8_t> bgr);

} // namespace q3rt
