// The converged picture of the room with one square light against the closed form, pixel by pixel, on every back end.

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

#include "truth/square_room.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr int kWidth = 48, kHeight = 36; ///< pixels
const Camera kCamera{.eye = {-200, -180, 100}, .pitch = 10, .yaw = 40};
constexpr double kTolerance = 0.01;      ///< of the closed form
constexpr double kErrors = 4;            ///< standard errors that chance may add
constexpr double kMeanTolerance = 0.001; ///< of the whole picture

struct Comparison {
    size_t pixels = 0, beyond = 0;
    double worst = 0, worstError = 0; ///< relative
    double mean = 0, meanError = 0;
};

Comparison compareWithClosedForm(const MeasuredPicture& picture) {
    Comparison result;
    double got = 0, expected = 0, variance = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (!isInsideOneWall(kCamera, kWidth, kHeight, x, y)) continue;
            const auto p = static_cast<size_t>(y * kWidth + x);
            const RoomPoint point = findRoomPoint(kCamera, kWidth, kHeight, x + 0.5, y + 0.5);
            const double closed =
                kTestWallAlbedo * squareLightRoom::computeIrradiance(point.position, point.normal) / 63.75;
            const double difference = std::abs(picture.mean[p].r - closed), error = std::sqrt(picture.variance[p].r);
            ++result.pixels;
            if (difference > kTolerance * closed + kErrors * error) ++result.beyond;
            got += picture.mean[p].r;
            expected += closed;
            variance += picture.variance[p].r;
            if (closed <= 0) continue;
            result.worst = std::max(result.worst, difference / closed);
            result.worstError = std::max(result.worstError, error / closed);
        }
    result.mean = got / expected - 1;
    result.meanError = std::sqrt(variance) / expected;
    return result;
}

MeasuredPicture measureRoom(FileSource& files, const char* backend) {
    TraceHarness harness(files, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    prepareHarness(harness, squareLightRoom::kName, {{"rt_backend", backend}, {"rt_numRandomDL", "64"}});
    return measurePicture(harness, kCamera, 8, 12);
}

TEST(SquareLightRoom, EveryPixelIsTheClosedFormOnEveryBackEnd) {
    TestGame game;
    std::optional<MeasuredPicture> first;
    for (const char* backend : {"compute", "query", "pipeline"}) {
        const MeasuredPicture picture = measureRoom(game, backend);
        ASSERT_EQ(picture.width, kWidth);
        const Comparison got = compareWithClosedForm(picture);
        std::printf("%s: %zu pixels, worst %.2f %% (standard errors up to %.2f %%), mean %+.4f %% +- %.4f %%\n",
                    backend, got.pixels, 100 * got.worst, 100 * got.worstError, 100 * got.mean, 100 * got.meanError);
        EXPECT_GT(got.pixels, size_t{kWidth * kHeight / 2});
        EXPECT_EQ(got.beyond, 0u) << backend;
        EXPECT_LT(std::abs(got.mean), kMeanTolerance) << backend;
        EXPECT_LT(got.worstError, kTolerance) << "too few samples to say anything";
        if (!first) first = picture;
        // The same numbers, the same points but for rounding: where two back ends differ, they differ by single rays.
        double largest = 0;
        for (size_t p = 0; p < picture.mean.size(); ++p)
            largest = std::max(largest, std::abs(picture.mean[p].r - first->mean[p].r));
        std::printf("%s: differs from the first back end by up to %.1e\n", backend, largest);
        EXPECT_LT(largest, 1e-4) << backend;
    }
}

} // namespace
} // namespace q3rt::test
