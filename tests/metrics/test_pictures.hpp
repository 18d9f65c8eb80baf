#pragma once
// The pictures that the expected values of these tests were computed for.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "metrics/metric_image.hpp"

namespace q3rt::test {

struct Pair {
    MetricImage reference, test;
};

/// 40 x 30 pixels: gradients, a product pattern and blocks; the test picture adds noise of -20..20 byte steps.
inline Pair makeNoisyPair() {
    constexpr int kWidth = 40, kHeight = 30;
    uint32_t state = 7;
    const auto nextByte = [&] {
        state = (state * 1103515245u + 12345u) & 0x7fffffffu;
        return static_cast<int>(state >> 16 & 255u);
    };
    std::vector<uint8_t> reference, noisy;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (const int base : {(6 * x + 2 * y) % 256, (x * y) % 256, (x / 8 + y / 6) % 2 != 0 ? 255 : 40}) {
                reference.push_back(static_cast<uint8_t>(base));
                noisy.push_back(static_cast<uint8_t>(std::clamp(base + nextByte() % 41 - 20, 0, 255)));
            }
    return {metricImageFromBytes(kWidth, kHeight, 3, reference), metricImageFromBytes(kWidth, kHeight, 3, noisy)};
}

inline MetricImage makeConstant(int width, int height, double red, double green, double blue) {
    MetricImage image{width, height, {}};
    for (size_t i = 0; i < image.pixelCount(); ++i)
        image.rgb.insert(image.rgb.end(), {red, green, blue});
    return image;
}

} // namespace q3rt::test
