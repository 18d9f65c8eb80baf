// Structural similarity: local means, variances and the covariance under a Gaussian window, combined as in the paper.

#include <array>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "metrics/filter.hpp"
#include "metrics/image_metrics.hpp"

namespace q3rt {

namespace {

constexpr double kSigmaPixels = 1.5, kPeak = 255.0;
constexpr double kC1 = (0.01 * kPeak) * (0.01 * kPeak), kC2 = (0.03 * kPeak) * (0.03 * kPeak);

std::array<double, kSsimWindow> makeWindow() {
    std::array<double, kSsimWindow> window{};
    for (int i = 0; i < kSsimWindow; ++i) {
        const double x = (i - kSsimWindow / 2) / kSigmaPixels;
        window[static_cast<size_t>(i)] = std::exp(-0.5 * x * x);
    }
    const double sum = std::accumulate(window.begin(), window.end(), 0.0);
    for (double& weight : window)
        weight /= sum;
    return window;
}

Plane2d lumaOf(const MetricImage& image) {
    Plane2d luma{image.width, image.height, std::vector<double>(image.pixelCount())};
    for (size_t i = 0; i < luma.values.size(); ++i)
        luma.values[i] =
            kPeak * (0.299 * image.rgb[3 * i] + 0.587 * image.rgb[3 * i + 1] + 0.114 * image.rgb[3 * i + 2]);
    return luma;
}

/// Windowed mean of a * b.
Plane2d meanOfProduct(const Plane2d& a, const Plane2d& b, const std::array<double, kSsimWindow>& window) {
    Plane2d product = a;
    for (size_t i = 0; i < product.values.size(); ++i)
        product.values[i] *= b.values[i];
    return convolveSeparable(product, window, window, Border::Valid);
}

} // namespace

MetricMap computeSsim(const MetricImage& reference, const MetricImage& test) {
    requireSameSize(reference, test);
    if (reference.width < kSsimWindow || reference.height < kSsimWindow)
        throw UsageError(formatText("SSIM wants %d x %d pixels or more, these pictures have %d x %d", kSsimWindow,
                                    kSsimWindow, reference.width, reference.height));
    const auto window = makeWindow();
    const Plane2d x = lumaOf(reference), y = lumaOf(test);
    const Plane2d meanX = convolveSeparable(x, window, window, Border::Valid);
    const Plane2d meanY = convolveSeparable(y, window, window, Border::Valid);
    const Plane2d meanXx = meanOfProduct(x, x, window), meanYy = meanOfProduct(y, y, window);
    const Plane2d meanXy = meanOfProduct(x, y, window);
    MetricMap map{meanX.width, meanX.height, std::vector<double>(meanX.values.size()), 0};
    for (size_t i = 0; i < map.values.size(); ++i) {
        const double mx = meanX.values[i], my = meanY.values[i];
        const double varianceX = meanXx.values[i] - mx * mx, varianceY = meanYy.values[i] - my * my;
        const double covariance = meanXy.values[i] - mx * my;
        map.values[i] =
            (2 * mx * my + kC1) * (2 * covariance + kC2) / ((mx * mx + my * my + kC1) * (varianceX + varianceY + kC2));
    }
    map.mean = std::accumulate(map.values.begin(), map.values.end(), 0.0) / static_cast<double>(map.values.size());
    return map;
}

} // namespace q3rt
