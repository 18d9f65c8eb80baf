#pragma once
// The picture that every metric takes: RGB in doubles, display-encoded, 1.0 = full brightness of a channel.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace q3rt {

struct MetricImage {
    int width = 0, height = 0;
    std::vector<double> rgb; ///< width * height * 3, top row first; [0, 1] from bytes, any finite value from floats

    size_t pixelCount() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

/// One value a pixel, and their mean.
struct MetricMap {
    int width = 0, height = 0;
    std::vector<double> values; ///< top row first
    double mean = 0;
};

/// From 8-bit pixels of 3 or 4 channels; a fourth is ignored.
MetricImage metricImageFromBytes(int width, int height, int channels, std::span<const uint8_t> pixels);
/// From float RGB. Throws ContentError at a value that is not finite: no metric means anything then.
MetricImage metricImageFromFloats(int width, int height, std::span<const float> rgb);
/// Every value cut to [0, 1]: what a display shows of a float picture.
MetricImage clampToDisplay(MetricImage image);
/// Throws UsageError unless both have the same size and at least one pixel.
void requireSameSize(const MetricImage& reference, const MetricImage& test);

} // namespace q3rt
