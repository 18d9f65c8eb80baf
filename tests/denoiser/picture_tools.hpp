#pragma once
// What the tests of whole pictures share.

#include <cmath>

#include "tests/tracer/trace_harness.hpp"
#include "tests/truth/test_game.hpp"

namespace q3rt::test {

inline double meanOf(const FloatImage& image) {
    double sum = 0;
    for (const float value : image.rgb)
        sum += value;
    return sum / static_cast<double>(image.rgb.size());
}

inline double meanOf(const HostFrame& picture) {
    double sum = 0;
    for (const uint8_t value : picture.rgb)
        sum += value;
    return sum / static_cast<double>(picture.rgb.size());
}

/// Root mean square.
inline double errorOf(const FloatImage& image, const FloatImage& reference) {
    double sum = 0;
    for (size_t i = 0; i < image.rgb.size(); ++i)
        sum += std::pow(image.rgb[i] - reference.rgb[i], 2);
    return std::sqrt(sum / static_cast<double>(image.rgb.size()));
}

} // namespace q3rt::test
