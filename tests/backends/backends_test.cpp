// The same pictures from every back end. They differ where rounding decides: at silhouettes, at the edges of shadows,
// and on surfaces that share a plane.

#include <cstdlib>
#include <optional>

#include <gtest/gtest.h>

#include "host/still/map_stage.hpp"
#include "support/backend_time.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

constexpr PictureSize kSize{320, 240};
constexpr float kFovDegrees = 90;
constexpr int kClockMs = 4321;     ///< waves and scrolls are under way
constexpr double kMeanBound = 0.2; ///< mean absolute difference of channels, of 255
constexpr int kFarValue = 8;       ///< of 255: beyond it a pixel shows something else
constexpr double kFarPixelShare = 1e-4;

struct View {
    const char* map;
    const char* at;
};

/// The first ones are always drawn, all of them with Q3RT_LONG_TESTS=1.
constexpr View kViews[] = {{"fan", "-736 0 122 0 0"},
                           {"oa_dm1", "280 1416 -94 0 180"},
                           {"oa_shouse", "-1248 -1184 346 0 90"},
                           {"aggressor", "spawn:1"},
                           {"czest2ctf", "spawn:4"},
                           {"hydronex", "spawn:0"},
                           {"kaos", "spawn:2"},
                           {"oa_dm2", "spawn:0"},
                           {"oa_minia", "spawn:1"},
                           {"oa_pvomit", "spawn:0"},
                           {"oacmpctf3", "spawn:3"},
                           {"oacmpdm9", "spawn:1"}};
size_t viewCount() { return std::getenv("Q3RT_LONG_TESTS") ? std::size(kViews) : 3; }

const CvarList kSettings = {{"rt_seed", "1"}, {"rt_denoiser", "0"}, {"rt_taa", "0"}};

struct Pictures {
    HostFrame lit, plain;
};

HostFrame draw(HeadlessEngine& engine, const MapStage& stage, const View& view) {
    stage.drawScene(engine, makeView(stage.findEye(view.at), kFovDegrees, kSize.width, kSize.height, kClockMs));
    std::optional<HostFrame> frame = engine.endFrame(true);
    if (!frame) throw std::runtime_error("the module gave no picture");
    return *frame;
}

/// Nothing, with a reason, if the device lacks what the back end needs.
std::optional<Pictures> drawWith(const char* backend, Pk3FileSource& files, const View& view, std::string& reason) {
    const BackendTime time(backend);
    try {
        HeadlessEngine engine(files);
        engine.showsMessages = false;
        engine.clockMs = kClockMs;
        presetPicture(engine.cvars, kSize, kSettings);
        engine.cvars.preset("rt_backend", backend);
        engine.cvars.preset("rt_illumination", "2"); // made at loading
        engine.loadModule(Q3RT_BUILD_DIR "/renderer_rt_x86_64.so");
        MapStage stage(files, view.map);
        stage.load(engine);
        Pictures pictures;
        pictures.plain = draw(engine, stage, view);
        engine.cvars.preset("rt_illumination", "1");
        pictures.lit = draw(engine, stage, view);
        return pictures;
    } catch (const std::exception& error) {
        reason = error.what();
        if (reason.find("has no ray") == std::string::npos && reason.find("Vulkan") == std::string::npos) throw;
        return std::nullopt;
    }
}

void expectSame(const HostFrame& a, const HostFrame& b, const std::string& what) {
    ASSERT_EQ(a.rgb.size(), size_t{3} * kSize.width * kSize.height);
    ASSERT_EQ(a.rgb.size(), b.rgb.size());
    double mean = 0;
    size_t farPixels = 0;
    for (size_t pixel = 0; pixel < a.rgb.size() / 3; ++pixel) {
        int largest = 0;
        for (size_t k = 3 * pixel; k < 3 * pixel + 3; ++k) {
            const int difference = std::abs(int{a.rgb[k]} - int{b.rgb[k]});
            mean += difference;
            largest = std::max(largest, difference);
        }
        farPixels += largest > kFarValue ? 1 : 0;
    }
    mean /= static_cast<double>(a.rgb.size());
    std::printf("%s: mean difference %.5f of 255, %zu of %d pixels beyond %d\n", what.c_str(), mean, farPixels,
                kSize.width * kSize.height, kFarValue);
    EXPECT_LE(mean, kMeanBound) << what;
    EXPECT_LE(static_cast<double>(farPixels), kFarPixelShare * kSize.width * kSize.height) << what;
}

class Backends : public ::testing::TestWithParam<size_t> {};

TEST_P(Backends, ShowTheComputePicture) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const View& view = kViews[GetParam()];
    std::string reason;
    const auto expected = drawWith("compute", *files, view, reason);
    if (!expected) GTEST_SKIP() << reason;
    for (const char* backend : {"pipeline", "query"}) {
        const auto pictures = drawWith(backend, *files, view, reason);
        if (!pictures) {
            std::printf("%s left out: %s\n", backend, reason.c_str());
            continue;
        }
        const std::string name = std::string(view.map) + " " + backend;
        expectSame(pictures->lit, expected->lit, name);
        expectSame(pictures->plain, expected->plain, name + " plain");
    }
}

INSTANTIATE_TEST_SUITE_P(Views, Backends, ::testing::Range<size_t>(0, viewCount()),
                         [](const auto& info) { return std::string(kViews[info.param].map); });

} // namespace
} // namespace q3rt::test
