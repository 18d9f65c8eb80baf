// Pointwise errors: MSE, PSNR, relMSE.

#include <cmath>

#include "metrics/image_metrics.hpp"

namespace q3rt {

double computeMse(const MetricImage& reference, const MetricImage& test) {
    requireSameSize(reference, test);
    double sum = 0;
    for (size_t i = 0; i < reference.rgb.size(); ++i)
        sum += (test.rgb[i] - reference.rgb[i]) * (test.rgb[i] - reference.rgb[i]);
    return sum / static_cast<double>(reference.rgb.size());
}

double computePsnr(const MetricImage& reference, const MetricImage& test) {
    return -10.0 * std::log10(computeMse(reference, test));
}

double computeRelativeMse(const MetricImage& reference, const MetricImage& test) {
    requireSameSize(reference, test);
    double sum = 0;
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const double difference = test.rgb[i] - reference.rgb[i];
        sum += difference * difference / (reference.rgb[i] * reference.rgb[i] + kRelativeMseEpsilon);
    }
    return sum / static_cast<double>(reference.rgb.size());
}

} // namespace q3rt
