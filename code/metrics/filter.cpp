#include "metrics/filter.hpp"

#include <algorithm>
#include <cstddef>

namespace q3rt {

namespace {

/// Weighted sum of `count` values that are `stride` apart; position `first` may lie outside [0, length).
double weightedSum(const double* line, int length, std::ptrdiff_t stride, int first, std::span<const double> kernel) {
    double sum = 0;
    for (size_t k = 0; k < kernel.size(); ++k) {
        const int at = std::clamp(first + static_cast<int>(k), 0, length - 1);
        sum += kernel[k] * line[at * stride];
    }
    return sum;
}

} // namespace

Plane2d convolveSeparable(const Plane2d& source, std::span<const double> horizontal, std::span<const double> vertical,
                          Border border) {
    const bool valid = border == Border::Valid;
    const int radiusX = static_cast<int>(horizontal.size() / 2), radiusY = static_cast<int>(vertical.size() / 2);
    const int shiftX = valid ? 0 : radiusX, shiftY = valid ? 0 : radiusY;
    Plane2d rows{valid ? source.width - 2 * radiusX : source.width, source.height, {}};
    Plane2d result{rows.width, valid ? source.height - 2 * radiusY : source.height, {}};
    if (result.width <= 0 || result.height <= 0) return {};
    rows.values.resize(static_cast<size_t>(rows.width) * static_cast<size_t>(rows.height));
    result.values.resize(static_cast<size_t>(result.width) * static_cast<size_t>(result.height));
    for (int y = 0; y < rows.height; ++y)
        for (int x = 0; x < rows.width; ++x)
            rows.values[static_cast<size_t>(y) * static_cast<size_t>(rows.width) + static_cast<size_t>(x)] =
                weightedSum(&source.values[static_cast<size_t>(y) * static_cast<size_t>(source.width)], source.width, 1,
                            x - shiftX, horizontal);
    for (int y = 0; y < result.height; ++y)
        for (int x = 0; x < result.width; ++x)
            result.values[static_cast<size_t>(y) * static_cast<size_t>(result.width) + static_cast<size_t>(x)] =
                weightedSum(&rows.values[static_cast<size_t>(x)], rows.height, rows.width, y - shiftY, vertical);
    return result;
}

} // namespace q3rt
