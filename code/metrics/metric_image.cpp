#include "metrics/metric_image.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace q3rt {

namespace {

MetricImage makeImage(int width, int height, int channels, size_t valueCount) {
    if (width <= 0 || height <= 0 ||
        valueCount != static_cast<size_t>(width) * static_cast<size_t>(height) * static_cast<size_t>(channels))
        throw UsageError(formatText("a picture of %d x %d pixels with %d channels can't have %zu values", width, height,
                                    channels, valueCount));
    MetricImage image{width, height, {}};
    image.rgb.resize(image.pixelCount() * 3);
    return image;
}

} // namespace

MetricImage metricImageFromBytes(int width, int height, int channels, std::span<const uint8_t> pixels) {
    if (channels != 3 && channels != 4) throw UsageError(formatText("a picture has 3 or 4 channels, not %d", channels));
    MetricImage image = makeImage(width, height, channels, pixels.size());
    for (size_t pixel = 0; pixel < image.pixelCount(); ++pixel)
        for (size_t c = 0; c < 3; ++c)
            image.rgb[pixel * 3 + c] = pixels[pixel * static_cast<size_t>(channels) + c] / 255.0;
    return image;
}

MetricImage metricImageFromFloats(int width, int height, std::span<const float> rgb) {
    MetricImage image = makeImage(width, height, 3, rgb.size());
    for (size_t i = 0; i < rgb.size(); ++i) {
        if (!std::isfinite(rgb[i]))
            throw ContentError(formatText("pixel %zu, %zu is not finite", i / 3 % static_cast<size_t>(width),
                                          i / 3 / static_cast<size_t>(width)));
        image.rgb[i] = rgb[i];
    }
    return image;
}

MetricImage clampToDisplay(MetricImage image) {
    for (double& value : image.rgb)
        value = std::clamp(value, 0.0, 1.0);
    return image;
}

void requireSameSize(const MetricImage& reference, const MetricImage& test) {
    if (reference.width != test.width || reference.height != test.height)
        throw UsageError(formatText("the sizes differ: %d x %d and %d x %d pixels", reference.width, reference.height,
                                    test.width, test.height));
    if (reference.pixelCount() == 0) throw UsageError("the pictures are empty");
}

} // namespace q3rt
