// The module with denoiser and temporal anti-aliasing on, in the headless engine, in the room with the square light.

#include <gtest/gtest.h>

#include "picture_tools.hpp"

namespace q3rt {
namespace {

using test::Camera;
using test::errorOf;
using test::meanOf;
using test::TestGame;
using test::TraceHarness;

constexpr int kWidth = 48, kHeight = 36; ///< pixels
const Camera kCamera{.eye = {-200, -180, 100}, .pitch = 10, .yaw = 40};
const Camera kFarCamera{.eye = {220, 190, 40}, .pitch = 0, .yaw = 200};

const TraceHarness::Light kDynamicLight{.origin = {-60, -60, 80}, .radius = 300};

using Settings = std::vector<std::pair<std::string, std::string>>;

class DenoisedRoomTest : public testing::Test {
  protected:
    /// Draws all but the last of these frames; the first `litCount` of all have a dynamic light. A module at a time:
    /// two would share the loaded library.
    std::unique_ptr<TraceHarness> drawMost(const Settings& settings, const std::vector<Camera>& frames,
                                           size_t litCount = 0) {
        auto harness = std::make_unique<TraceHarness>(m_game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
        for (const auto& [name, value] : settings)
            harness->set(name, value);
        harness->loadMap(std::string("maps/") + squareLightRoom::kName + ".bsp");
        for (size_t i = 0; i < frames.size(); ++i) {
            harness->setLights(std::vector<TraceHarness::Light>(i < litCount ? 1 : 0, kDynamicLight));
            if (i + 1 < frames.size()) harness->draw(frames[i], 1);
        }
        return harness;
    }
    /// Radiance of the last frame: denoised, without anti-aliasing.
    FloatImage render(const Settings& settings, const std::vector<Camera>& frames) {
        return drawMost(settings, frames)->radiance(frames.back(), 1);
    }
    /// The last frame as it is shown.
    HostFrame show(const Settings& settings, const std::vector<Camera>& frames, size_t litCount = 0) {
        return drawMost(settings, frames, litCount)->picture(frames.back(), 1);
    }
    TestGame m_game;
};

TEST_F(DenoisedRoomTest, ComesCloseToTheReferenceInFewFrames) {
    const FloatImage reference = render({{"rt_accumulate", "1"}}, std::vector<Camera>(400, kCamera));
    const double raw = errorOf(render({{"rt_denoiser", "0"}, {"rt_taa", "0"}}, {kCamera}), reference);
    const FloatImage filtered = render({}, std::vector<Camera>(16, kCamera));
    EXPECT_LT(errorOf(filtered, reference), raw / 3) << "the room's light changes within a few of these large pixels";
    EXPECT_NEAR(meanOf(filtered) / meanOf(reference), 1, 0.01);
    std::printf("error of one sample %.4f, denoised after 16 frames %.4f, energy %+.2f %%\n", raw,
                errorOf(filtered, reference), 100 * (meanOf(filtered) / meanOf(reference) - 1));
}

TEST_F(DenoisedRoomTest, FixedSeedRepeatsBitForBit) {
    std::vector<Camera> path;
    for (int i = 0; i < 8; ++i) {
        Camera& camera = path.emplace_back(kCamera);
        camera.eye.x += static_cast<float>(i) * 5;
        camera.yaw += static_cast<float>(i);
    }
    const Settings settings{{"rt_antialiasing", "1"}};
    EXPECT_EQ(show(settings, path).rgb, show(settings, path).rgb);
}

TEST_F(DenoisedRoomTest, ACutLeavesNothingOfTheOldView) {
    std::vector<Camera> steady(8, kCamera);
    std::vector<Camera> moved(5, Camera{.eye = {-100, 60, 200}, .pitch = 40, .yaw = 10});
    moved.insert(moved.end(), 3, kCamera);
    steady.push_back(kFarCamera);
    moved.push_back(kFarCamera);
    EXPECT_EQ(show({}, steady).rgb, show({}, moved).rgb);
}

TEST_F(DenoisedRoomTest, ADynamicLightLeavesNoTrail) {
    constexpr size_t kLit = 20, kDark = 4;
    const std::vector<Camera> all(kLit + kDark, kCamera), lit(kLit, kCamera);
    const double without = meanOf(show({}, all)), with = meanOf(show({}, lit, kLit));
    const double after = meanOf(show({}, all, kLit));
    const double leftOver = (after - without) / (with - without);
    EXPECT_GT(with, 1.1 * without) << "the light shows";
    EXPECT_LE(std::abs(leftOver), 0.05);
    std::printf("of a dynamic light that adds %.0f %%, %.2f %% are left after %zu frames\n", 100 * (with / without - 1),
                100 * leftOver, kDark);
}

TEST_F(DenoisedRoomTest, WhatIsOffLeavesNoTrace) {
    // The first sample of a mean is the plain sample.
    const FloatImage plain = render({{"rt_denoiser", "0"}, {"rt_taa", "0"}}, {kCamera});
    EXPECT_EQ(plain.rgb, render({{"rt_accumulate", "1"}}, {kCamera}).rgb);
    EXPECT_NE(plain.rgb, render({}, {kCamera}).rgb);
}

} // namespace
} // namespace q3rt
