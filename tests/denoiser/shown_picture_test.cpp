// What is shown: scaled, split, exposed, paused.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "picture_tools.hpp"
#include "shaders/shared/rt_exposure.h"

namespace q3rt {
namespace {

using test::Camera;
using test::meanOf;
using test::TestGame;
using test::TraceHarness;

using Settings = std::vector<std::pair<std::string, std::string>>;

constexpr int kWidth = 48, kHeight = 36; ///< pixels
const Camera kCamera{.eye = {-200, -180, 100}, .pitch = 10, .yaw = 40};

class ShownPictureTest : public testing::Test {
  protected:
    std::unique_ptr<TraceHarness> makeRoom(const Settings& settings, const char* module = "renderer_rt") {
        auto harness = std::make_unique<TraceHarness>(m_game, std::string(Q3RT_BUILD_DIR "/") + module + "_x86_64.so",
                                                      kWidth, kHeight);
        for (const auto& [name, value] : settings)
            harness->set(name, value);
        harness->loadMap(std::string("maps/") + squareLightRoom::kName + ".bsp");
        return harness;
    }
    HostFrame show(const Settings& settings, int frames, const char* module = "renderer_rt") {
        return makeRoom(settings, module)->picture(kCamera, frames);
    }
    TestGame m_game;
};

/// Largest difference of bytes in columns [first, end).
int worstDifference(const HostFrame& a, const HostFrame& b, int first, int end) {
    int worst = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int i = (y * kWidth + first) * 3; i < (y * kWidth + end) * 3; ++i)
            worst = std::max(worst, std::abs(int{a.rgb[static_cast<size_t>(i)]} - int{b.rgb[static_cast<size_t>(i)]}));
    return worst;
}

double rmsDifference(const HostFrame& a, const HostFrame& b) {
    double sum = 0;
    for (size_t i = 0; i < a.rgb.size(); ++i)
        sum += std::pow(a.rgb[i] - b.rgb[i], 2);
    return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

TEST_F(ShownPictureTest, AScaledPictureTendsToTheWholeOne) {
    const HostFrame whole = show({{"rt_accumulate", "1"}, {"rt_antialiasing", "1"}}, 200);
    const double after = rmsDifference(show({{"rt_scale", "50"}}, 48), whole);
    const double first = rmsDifference(show({{"rt_scale", "50"}}, 1), whole);
    const double without = rmsDifference(show({{"rt_scale", "50"}, {"rt_taa", "0"}}, 48), whole);
    std::printf("bytes from the reference at half the size: %.2f in one frame, %.2f after 48, %.2f without history\n",
                first, after, without);
    // What is left is light, which is denoised at the traced size: 24 x 18 pixels have no more of it.
    EXPECT_LT(after, 0.7 * first);
    EXPECT_LT(after, 0.95 * without);
}

TEST_F(ShownPictureTest, ComparesWithTheRasteriser) {
    const HostFrame split = show({{"rt_compare", "1"}}, 4);
    EXPECT_EQ(worstDifference(split, show({}, 4, "renderer_vk"), 0, kWidth / 2), 0);
    EXPECT_EQ(worstDifference(split, show({}, 4), kWidth / 2, kWidth), 0);
}

TEST_F(ShownPictureTest, ComparesWithTheAccumulated) {
    const HostFrame split = show({{"rt_compare", "2"}}, 8);
    EXPECT_EQ(worstDifference(split, show({}, 8), 0, kWidth / 2), 0);
    // The samples are not the same ones: the denoiser carries some from frame to frame.
    const HostFrame accumulated = show({{"rt_accumulate", "1"}}, 8);
    EXPECT_LT(worstDifference(split, accumulated, kWidth / 2, kWidth), 40);
    EXPECT_GT(worstDifference(split, show({}, 8), kWidth / 2, kWidth), 2);
}

TEST_F(ShownPictureTest, LightHasAFloor) {
    const HostFrame dark = show({{"rt_exposure", "0.01"}}, 8);
    const HostFrame floor = show({{"rt_exposure", "0.01"}, {"rt_minLight", "0.5"}}, 8);
    EXPECT_LT(meanOf(dark), 10);
    // Walls are 153: half of that, the lamp excepted.
    EXPECT_NEAR(meanOf(floor), 153 * 0.5, 8);
}

TEST_F(ShownPictureTest, MapOverbrightBitsScaleTheLight) {
    // Where no glow is seen.
    const Camera down{.eye = {-100, -100, 200}, .pitch = 80, .yaw = 0};
    const HostFrame usual = makeRoom({{"rt_exposure", "0.25"}})->picture(down, 4);
    const HostFrame scaled = makeRoom({{"rt_exposure", "0.125"}, {"r_mapOverBrightBits", "3"}})->picture(down, 4);
    EXPECT_EQ(worstDifference(usual, scaled, 0, kWidth), 0);
}

TEST_F(ShownPictureTest, GammaIsBakedIntoTextures) {
    EXPECT_GT(meanOf(show({{"r_gamma", "2"}}, 4)), 1.1 * meanOf(show({}, 4)));
}

TEST_F(ShownPictureTest, LinearLightDarkensTexturesAndBrightensTheMiddle) {
    // Light 1 shows a texture as it is, in both: the decoded texture is encoded again.
    const Settings bright{{"rt_exposure", "100"}, {"rt_minLight", "1"}}; // dark corners too
    Settings linear = bright;
    linear.emplace_back("rt_linear", "1");
    EXPECT_LE(worstDifference(show(bright, 4), show(linear, 4), 0, kWidth), 1);
    EXPECT_GT(meanOf(show({{"rt_exposure", "0.1"}, {"rt_linear", "1"}}, 4)),
              1.5 * meanOf(show({{"rt_exposure", "0.1"}}, 4)));
}

TEST_F(ShownPictureTest, ExposureAdaptsAtABoundedSpeed) {
    const auto harness = makeRoom({{"rt_autoExposure", "1"}, {"rt_exposure", "0.5"}, {"rt_exposureSpeed", "2"}});
    Camera camera = kCamera;
    std::vector<double> means;
    for (int i = 0; i < 40; ++i) {
        means.push_back(meanOf(harness->picture(camera, 1)));
        camera.timeMs += 100;
    }
    EXPECT_NEAR(means[0], meanOf(show({{"rt_exposure", "0.5"}}, 1)), 1) << "it begins at rt_exposure";
    // 0.2 stops a frame at most; the room is too bright.
    for (size_t i = 1; i < means.size(); ++i)
        EXPECT_GT(means[i] / means[i - 1], std::exp2(-0.2) * 0.98) << i;
    EXPECT_NEAR(means[39] / means[30], 1, 0.02) << "it has arrived";
    EXPECT_NEAR(means[39], 0.5 * 255 * static_cast<double>(kExposureKey), 8) << "the key, times rt_exposure";
}

TEST_F(ShownPictureTest, PauseStopsTheGame) {
    const auto harness = makeRoom({});
    const auto frozen = [&] {
        return harness->engine().cvars.value("cl_freezeDemo") + harness->engine().cvars.value("cl_paused");
    };
    harness->draw(kCamera, 1);
    EXPECT_NE(frozen(), "11");
    for (const char* name : {"rt_pause", "rt_accumulate"}) {
        harness->set(name, "1");
        harness->draw(kCamera, 1);
        EXPECT_EQ(frozen(), "11") << name;
        harness->set(name, "0");
        harness->draw(kCamera, 1);
        EXPECT_EQ(frozen(), "00") << name;
    }
}

TEST_F(ShownPictureTest, NumbersShowOnThePictureAndNotOnAKeptMean) {
    const HostFrame plain = show({{"rt_accumulate", "1"}}, 3);
    const Settings overlay{{"rt_accumulate", "1"}, {"rt_printPerfStats", "2"}};
    EXPECT_EQ(plain.rgb, show(overlay, 3).rgb) << "the game has no font";
    // Every character is a white box.
    m_game.add("gfx/2d/bigchars.png", encodePng(16, 16, 3, std::vector<uint8_t>(16 * 16 * 3, 255)));
    EXPECT_EQ(plain.rgb, show({{"rt_accumulate", "1"}}, 3).rgb);
    const HostFrame numbers = show(overlay, 3);
    EXPECT_GT(worstDifference(plain, numbers, 6, kWidth), 100);
    EXPECT_EQ(worstDifference(plain, numbers, 0, 6), 0) << "there is a margin";
}

TEST_F(ShownPictureTest, RaysAreCounted) {
    const auto harness = makeRoom({{"rt_countWork", "1"}, {"q3rt_wantStats", "1"}, {"rt_numRandomDL", "1"}});
    const auto countRays = [&] {
        harness->draw(kCamera, 4); // counts come some frames late
        return nlohmann::json::parse(harness->engine().cvars.value("q3rt_stats")).at("rays").get<int>();
    };
    constexpr int kPixels = kWidth * kHeight;
    const int one = countRays();
    // The room is closed: a pixel looks once. It asks at most once for its light.
    EXPECT_GT(one, kPixels);
    EXPECT_LE(one, 2 * kPixels);
    harness->set("rt_numRandomDL", "3");
    const int three = countRays();
    EXPECT_GT(three - kPixels, 2 * (one - kPixels));
    EXPECT_LE(three, 4 * kPixels);
}

TEST_F(ShownPictureTest, NothingIsInfiniteInAnyPass) {
    const auto harness = makeRoom({{"rt_checkFinite", "1"}, {"q3rt_wantStats", "1"}, {"rt_autoExposure", "1"}});
    harness->draw(kCamera, 5);
    const auto stats = nlohmann::json::parse(harness->engine().cvars.value("q3rt_stats"));
    for (const char* pass : {"look", "primary", "choose", "denoise carry", "denoise temporal", "denoise variance",
                             "denoise filter", "denoise gradient", "denoise gradient filter", "composite", "taa"}) {
        ASSERT_TRUE(stats["nonfinite"].contains(pass)) << pass;
        EXPECT_EQ(stats["nonfinite"][pass], 0) << pass;
    }
}

TEST_F(ShownPictureTest, PlainShadingIsReported) {
    const auto harness =
        makeRoom({{"rt_checkFinite", "1"}, {"rt_countWork", "1"}, {"q3rt_wantStats", "1"}, {"rt_illumination", "2"}});
    harness->draw(kCamera, 5);
    const auto stats = nlohmann::json::parse(harness->engine().cvars.value("q3rt_stats"));
    EXPECT_GT(stats.at("rays").get<int>(), kWidth * kHeight);
    EXPECT_LE(stats.at("rays").get<int>(), 2 * kWidth * kHeight);
    EXPECT_EQ(stats.at("nonfinite").at("plain"), 0);
}

} // namespace
} // namespace q3rt
