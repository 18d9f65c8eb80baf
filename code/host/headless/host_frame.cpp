#include "host/headless/host_frame.hpp"

namespace q3rt {

HostFrame frameFromVideo(int width, int height, std::span<const uint8_t> bgr) {
    const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
    const size_t rowBytes = (columns * 3 + 3) & ~size_t{3};
    if (width <= 0 || height <= 0 || bgr.size() != rowBytes * rows) return {};
    HostFrame frame{width, height, std::vector<uint8_t>(columns * rows * 3)};
    for (size_t y = 0; y < rows; ++y) {
        const uint8_t* from = bgr.data() + (rows - 1 - y) * rowBytes;
        uint8_t* to = frame.rgb.data() + y * columns * 3;
        for (size_t x = 0; x < columns; ++x, from += 3, to += 3) {
            to[0] = from[2];
            to[1] = from[1];
            to[2] = from[0];
        }
    }
    return frame;
}

} // namespace q3rt
