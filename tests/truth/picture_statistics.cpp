#include "picture_statistics.hpp"

#include <cmath>

namespace q3rt::test {

namespace {

constexpr int kTile = 8;             ///< pixels
constexpr double kErrorsAllowed = 4; ///< standard errors

double luminanceOf(const dvec3& c) { return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b; }

} // namespace

MeasuredPicture measurePicture(TraceHarness& harness, const Camera& camera, int seeds, int frames, int firstSeed) {
    MeasuredPicture result;
    std::vector<dvec3> squares;
    for (int i = 0; i < seeds; ++i) {
        harness.set("rt_seed", std::to_string(firstSeed + i));
        const FloatImage image = harness.radiance(camera, frames);
        const size_t count = image.rgb.size() / 3;
        result.width = image.width, result.height = image.height;
        result.mean.resize(count, dvec3(0.0));
        squares.resize(count, dvec3(0.0));
        for (size_t p = 0; p < count; ++p) {
            // Welford's running mean and sum of squares.
            const dvec3 value(image.rgb[3 * p], image.rgb[3 * p + 1], image.rgb[3 * p + 2]);
            const dvec3 step = value - result.mean[p];
            result.mean[p] += step / double(i + 1);
            squares[p] += step * (value - result.mean[p]);
        }
    }
    for (const dvec3& square : squares)
        result.variance.push_back(square / (double(seeds) * std::max(1, seeds - 1)));
    return result;
}

TileComparison compareTiles(const MeasuredPicture& first, const MeasuredPicture& second) {
    TileComparison result;
    double sumFirst = 0, sumSecond = 0, variance = 0;
    for (int ty = 0; ty + kTile <= first.height; ty += kTile)
        for (int tx = 0; tx + kTile <= first.width; tx += kTile) {
            dvec3 difference(0.0), tileVariance(0.0);
            for (int y = ty; y < ty + kTile; ++y)
                for (int x = tx; x < tx + kTile; ++x) {
                    const auto p = static_cast<size_t>(y * first.width + x);
                    difference += second.mean[p] - first.mean[p];
                    tileVariance += first.variance[p] + second.variance[p];
                    sumFirst += luminanceOf(first.mean[p]);
                    sumSecond += luminanceOf(second.mean[p]);
                    const dvec3 deviation = glm::sqrt(first.variance[p] + second.variance[p]);
                    variance += luminanceOf(deviation) * luminanceOf(deviation);
                }
            ++result.tiles;
            double worst = 0;
            for (int c = 0; c < 3; ++c) {
                const double error = std::sqrt(tileVariance[c]);
                // Without noise the sums differ by their rounding only.
                const double rounding = 1e-6 * (sumFirst + sumSecond);
                worst = std::max(worst, std::max(0.0, std::abs(difference[c]) - rounding) / std::max(error, 1e-30));
            }
            result.worst = std::max(result.worst, worst);
            if (worst > kErrorsAllowed) ++result.beyond;
        }
    result.luminanceRatio = sumSecond / sumFirst;
    result.luminanceError = std::sqrt(variance) / sumFirst;
    return result;
}

void prepareHarness(TraceHarness& harness, const std::string& map,
                    const std::vector<std::pair<std::string, std::string>>& settings) {
    harness.set("rt_accumulate", "1");
    harness.set("rt_tonemap", "1"); // the other curve clamps light before the radiance is written
    harness.set("rt_ambient", "0");
    for (const auto& [name, value] : settings)
        harness.set(name, value);
    harness.loadMap("maps/" + map + ".bsp");
}

dvec3 rayDirection(const Camera& camera, int width, int height, double x, double y) {
    const double yaw = camera.yaw * M_PI / 180, pitch = camera.pitch * M_PI / 180;
    const dvec3 forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), -std::sin(pitch));
    const dvec3 left(-std::sin(yaw), std::cos(yaw), 0);
    const dvec3 up(std::sin(pitch) * std::cos(yaw), std::sin(pitch) * std::sin(yaw), std::cos(pitch));
    const double tanX = std::tan(camera.fovX * M_PI / 360), tanY = tanX * height / width;
    return glm::normalize(forward + left * (tanX * (1 - 2 * x / width)) + up * (tanY * (1 - 2 * y / height)));
}

} // namespace q3rt::test
