// Depth of field: the picture of an edge out of focus, against the closed form of a thin lens.

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "truth/picture_statistics.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr int kWidth = 16, kHeight = 96; ///< pixels
constexpr double kDistance = 200;        ///< of the edge from the lens, qu

/// Share of a unit disc left of a chord at x.
double discShare(double x) {
    if (x <= -1 || x >= 1) return x < 0 ? 0 : 1;
    return 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / std::numbers::pi;
}

/// Under an edge of the room's light, looking up at it: upper half light, lower half ceiling, both in plain colours.
const Camera kUnderEdge{.eye = {64, 0, 256 - float(kDistance)}, .pitch = -90, .fovX = 4};

struct Profile {
    double worst = 0, radius = 0; ///< radius of the circle of confusion, pixels
};

/// The edge's picture against the share of the lens that sees the light.
Profile compareProfile(double aperture, double focus, int frames) {
    TestGame game;
    TraceHarness harness(game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    harness.set("rt_illumination", "0");
    harness.set("rt_dof", "1");
    harness.set("rt_aperture", std::to_string(aperture));
    harness.set("rt_focallength", std::to_string(focus));
    harness.set("rt_backend", "compute");
    prepareHarness(harness, squareLightRoom::kName, {});
    const FloatImage image = harness.radiance(kUnderEdge, frames);
    const double pixel = 2 * std::tan(kUnderEdge.fovX * std::numbers::pi / 360) / kWidth;
    // A point at distance d lights the disc of rays that reach it: aperture |1/d - 1/f| wide in tangents.
    Profile result{.radius = 0.5 * aperture * std::abs(1 / kDistance - 1 / focus) / pixel};
    for (int y = 0; y < kHeight; ++y) {
        const double above = kHeight / 2 - (y + 0.5); // of the edge, pixels
        const double share = result.radius > 0 ? discShare(above / result.radius) : (above > 0 ? 1.0 : 0.0);
        const double expected = kTestWallAlbedo + (1 - kTestWallAlbedo) * share;
        for (int x = 0; x < kWidth; ++x)
            result.worst = std::max(result.worst,
                                    std::abs(double(image.rgb[static_cast<size_t>(3 * (y * kWidth + x))]) - expected));
    }
    return result;
}

TEST(Lens, BlursAnEdgeByItsCircleOfConfusion) {
    constexpr int kFrames = 128;
    for (const double focus : {100.0, 300.0, 2000.0}) {
        const Profile profile = compareProfile(16, focus, kFrames);
        EXPECT_GT(profile.radius, 3);
        EXPECT_LT(profile.radius, kHeight / 2);
        EXPECT_LT(profile.worst, 0.03) << "focus " << focus << ": plain chance has a standard error of 0.018";
        std::printf("focus %.0f qu: radius %.2f pixels, worst %.4f\n", focus, profile.radius, profile.worst);
    }
}

TEST(Lens, ShowsWhatIsInFocusSharp) {
    EXPECT_LT(compareProfile(16, kDistance, 32).worst, 1e-5);
    EXPECT_LT(compareProfile(0, 100, 1).worst, 1e-5) << "no lens, no blur";
}

} // namespace
} // namespace q3rt::test
