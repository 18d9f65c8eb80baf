// The same pictures from every back end. They differ where rounding decides: at silhouettes, at the edges of shadows,
// and on surfaces that share a plane.

#include <cstdlib>
#include <optional>

#include <gtest/gtest.h>

#include "support/game_data.hpp"
#include "tracer/trace_harness.hpp"

namespace q3rt::test {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr double kMeanBound = 0.2; ///< mean absolute difference of channels, of 255
constexpr int kFarValue = 8;       ///< of 255: beyond it a pixel shows something else
constexpr double kFarPixelShare = 1e-4;

struct View {
    const char* map;
    Camera camera;
};

const View kViews[] = {{"fan", {.eye = {-736, 0, 122}, .yaw = 0}},
                       {"oa_dm1", {.eye = {280, 1416, -94}, .yaw = 180}},
                       {"oa_shouse", {.eye = {-1248, -1184, 346}, .yaw = 90}}};

/// The picture of one back end, or what the device lacks for it.
std::optional<HostFrame> drawWith(const char* backend, FileSource& files, const View& view, std::string& reason) {
    try {
        TraceHarness harness(files, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
        for (const auto& [cvar, value] : {std::pair{"rt_backend", backend},
                                          {"rt_seed", "1"},
                                          {"rt_denoiser", "0"},
                                          {"rt_taa", "0"},
                                          {"rt_antialiasing", "0"}})
            harness.set(cvar, value);
        harness.loadMap(std::string("maps/") + view.map + ".bsp");
        return harness.picture(view.camera, 1);
    } catch (const std::exception& error) {
        reason = error.what();
        if (reason.find("has no ray") == std::string::npos && reason.find("Vulkan") == std::string::npos) throw;
        return std::nullopt;
    }
}

struct Difference {
    double mean = 0;
    size_t farPixels = 0;
};

Difference compare(const HostFrame& a, const HostFrame& b) {
    Difference result;
    for (size_t pixel = 0; pixel < a.rgb.size() / 3; ++pixel) {
        int largest = 0;
        for (size_t k = 3 * pixel; k < 3 * pixel + 3; ++k) {
            const int difference = std::abs(int{a.rgb[k]} - int{b.rgb[k]});
            result.mean += difference;
            largest = std::max(largest, difference);
        }
        result.farPixels += largest > kFarValue ? 1 : 0;
    }
    result.mean /= static_cast<double>(a.rgb.size());
    return result;
}

class Backends : public ::testing::TestWithParam<const char*> {};

TEST_P(Backends, ShowTheComputePicture) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    for (const View& view : kViews) {
        std::string reason;
        const auto expected = drawWith("compute", *files, view, reason);
        if (!expected) GTEST_SKIP() << reason;
        const auto picture = drawWith(GetParam(), *files, view, reason);
        if (!picture) GTEST_SKIP() << reason;
        ASSERT_EQ(picture->rgb.size(), size_t{3} * kWidth * kHeight);
        ASSERT_EQ(picture->rgb.size(), expected->rgb.size());
        const Difference difference = compare(*picture, *expected);
        std::printf("%s %s: mean difference %.4f of 255, %zu of %d pixels beyond %d\n", view.map, GetParam(),
                    difference.mean, difference.farPixels, kWidth * kHeight, kFarValue);
        EXPECT_LE(difference.mean, kMeanBound) << view.map;
        EXPECT_LE(static_cast<double>(difference.farPixels), kFarPixelShare * kWidth * kHeight) << view.map;
    }
}

INSTANTIATE_TEST_SUITE_P(Structures, Backends, ::testing::Values("pipeline", "query"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace q3rt::test
