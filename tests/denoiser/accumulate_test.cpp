// Plain samples accumulated: how the error falls, and whether it knows itself.

#include <cstdlib>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "metrics/image_metrics.hpp"
#include "picture_tools.hpp"

namespace q3rt {
namespace {

using test::Camera;
using test::errorOf;
using test::TestGame;
using test::TraceHarness;

const Camera kCamera{.eye = {-200, -180, 100}, .pitch = 10, .yaw = 40};

class AccumulateTest : public testing::Test {
  protected:
    std::unique_ptr<TraceHarness> makeRoom(int seed, int width, int height) {
        auto harness = std::make_unique<TraceHarness>(m_game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", width, height);
        harness->set("rt_accumulate", "1");
        harness->set("rt_seed", std::to_string(seed));
        harness->set("q3rt_wantStats", "1");
        harness->loadMap(std::string("maps/") + squareLightRoom::kName + ".bsp");
        return harness;
    }
    /// Radiance after each of these counts of frames.
    std::vector<FloatImage> accumulate(int seed, const std::vector<int>& counts, int width, int height) {
        const auto harness = makeRoom(seed, width, height);
        std::vector<FloatImage> means;
        int drawn = 0;
        for (const int count : counts) {
            means.push_back(harness->radiance(kCamera, count - drawn));
            drawn = count;
        }
        return means;
    }
    /// Root mean square error of means of so many frames: what two seeds differ by, over sqrt 2.
    std::vector<double> measureErrors(const std::vector<int>& counts, int width, int height) {
        const std::vector<FloatImage> a = accumulate(1, counts, width, height);
        const std::vector<FloatImage> b = accumulate(2, counts, width, height);
        std::vector<double> errors;
        for (size_t i = 0; i < counts.size(); ++i) {
            errors.push_back(errorOf(a[i], b[i]) / std::sqrt(2.0));
            std::printf("%d frames: error %.6f\n", counts[i], errors.back());
        }
        return errors;
    }
    TestGame m_game;
};

/// Of a line through log error over log count, least squares.
double slopeOf(const std::vector<int>& counts, const std::vector<double>& errors) {
    double sumX = 0, sumY = 0, sumXX = 0, sumXY = 0;
    const auto n = static_cast<double>(counts.size());
    for (size_t i = 0; i < counts.size(); ++i) {
        const double x = std::log(counts[i]), y = std::log(errors[i]);
        sumX += x;
        sumY += y;
        sumXX += x * x;
        sumXY += x * y;
    }
    return (n * sumXY - sumX * sumY) / (n * sumXX - sumX * sumX);
}

TEST_F(AccumulateTest, TheErrorFallsWithTheRootOfTheCount) {
    const std::vector<int> counts{16, 32, 64, 128, 256, 512};
    EXPECT_LE(slopeOf(counts, measureErrors(counts, 24, 18)), -0.45);
}

TEST_F(AccumulateTest, LongSumsStillImprove) {
    if (!std::getenv("Q3RT_LONG_TESTS")) GTEST_SKIP() << "Q3RT_LONG_TESTS=1 draws 131,072 frames";
    const std::vector<int> counts{16, 64, 256, 1024, 4096, 16384, 65536};
    const std::vector<double> errors = measureErrors(counts, 16, 12);
    EXPECT_LE(slopeOf({counts.begin(), counts.begin() + 5}, {errors.begin(), errors.begin() + 5}), -0.45);
    EXPECT_LT(errors[6], 0.6 * errors[5]);
}

TEST_F(AccumulateTest, KnowsItsOwnError) {
    constexpr int kWidth = 64, kHeight = 48, kCount = 24, kManyFrames = 400;
    const auto pictureOf = [&](int seed, int frames, nlohmann::json& stats) {
        const auto harness = makeRoom(seed, kWidth, kHeight);
        const HostFrame picture = harness->picture(kCamera, frames);
        // What a frame counts is known two frames later.
        harness->draw(kCamera, 2);
        stats = nlohmann::json::parse(harness->engine().cvars.value("q3rt_stats"));
        return metricImageFromBytes(picture.width, picture.height, 3, picture.rgb);
    };
    nlohmann::json few, many;
    const MetricImage picture = pictureOf(1, kCount, few), reference = pictureOf(2, kManyFrames, many);
    const double ssim = computeSsim(reference, picture).mean, rms = std::sqrt(computeMse(reference, picture));
    std::printf("%d frames: SSIM %.4f, expected %.4f; error %.5f, expected %.5f\n", kCount, ssim,
                few["expected_ssim"].get<double>(), rms, few["standard_error"].get<double>());
    EXPECT_NEAR(few["expected_ssim"].get<double>(), ssim, 0.05);
    EXPECT_NEAR(few["standard_error"].get<double>() / rms, 1, 0.35) << "bytes round";
    EXPECT_EQ(few["samples"].get<int>(), kCount + 2);
    EXPECT_GT(many["expected_ssim"].get<double>(), few["expected_ssim"].get<double>());
    EXPECT_LT(many["standard_error"].get<double>(), 0.35 * few["standard_error"].get<double>());
}

} // namespace
} // namespace q3rt
