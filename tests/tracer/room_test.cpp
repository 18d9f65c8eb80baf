// The whole ray tracer, in the headless engine, against a room whose light is known in closed form.

#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/truth/square_room.hpp"
#include "tests/truth/test_game.hpp"
#include "trace_harness.hpp"

namespace q3rt {
namespace {

using test::Camera;
using test::RoomPoint;
using test::TestGame;
using test::TraceHarness;

constexpr int kWidth = 48, kHeight = 36, kTile = 6; ///< pixels
const Camera kCamera{.eye = {-200, -180, 100}, .pitch = 10, .yaw = 40};

RoomPoint pointBehind(double x, double y) { return test::findRoomPoint(kCamera, kWidth, kHeight, x, y); }

class RoomTest : public testing::Test {
  protected:
    /// Radiance of `map` under a back end, mean of `frames`.
    FloatImage render(const char* backend, const char* map, int frames,
                      const std::vector<std::pair<std::string, std::string>>& settings = {}) {
        TraceHarness harness(m_game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
        harness.set("rt_backend", backend);
        harness.set("rt_accumulate", "1");
        harness.set("rt_ambient", "0");
        for (const auto& [name, value] : settings)
            harness.set(name, value);
        harness.loadMap(std::string("maps/") + map + ".bsp");
        return harness.radiance(kCamera, frames);
    }
    TestGame m_game;
};

struct Comparison {
    double worstTile = 0, mean = 0; ///< relative errors
    int tiles = 0;
};

/// Tiles that touch the light or an edge of the room by their border are left out: a pixel there is no single point.
Comparison compareWithClosedForm(const FloatImage& image) {
    Comparison result;
    double allGot = 0, allExpected = 0;
    for (int ty = 0; ty < kHeight; ty += kTile)
        for (int tx = 0; tx < kWidth; tx += kTile) {
            double got = 0, expected = 0;
            bool usable = true;
            const dvec3 normal = pointBehind(tx - 1, ty - 1).normal;
            for (const auto& [dx, dy] : {std::pair{-2, -2}, {kTile + 2, -2}, {-2, kTile + 2}, {kTile + 2, kTile + 2}}) {
                const RoomPoint corner = pointBehind(tx + dx, ty + dy);
                usable = usable && corner.normal == normal && !corner.onLight;
            }
            for (int y = ty; y < ty + kTile && usable; ++y)
                for (int x = tx; x < tx + kTile; ++x) {
                    const RoomPoint point = pointBehind(x + 0.5, y + 0.5);
                    usable = usable && !point.onLight && point.normal == normal;
                    expected +=
                        kTestWallAlbedo * squareLightRoom::computeIrradiance(point.position, point.normal) / 63.75;
                    got += image.rgb[static_cast<size_t>(3 * (y * kWidth + x))];
                }
            if (!usable || expected <= 0) continue;
            ++result.tiles;
            allGot += got;
            allExpected += expected;
            result.worstTile = std::max(result.worstTile, std::abs(got / expected - 1));
        }
    result.mean = allGot / allExpected - 1;
    return result;
}

TEST_F(RoomTest, ConvergesToTheClosedFormOnEveryBackEnd) {
    for (const char* backend : {"compute", "pipeline", "query"}) {
        const FloatImage image = render(backend, squareLightRoom::kName, 384);
        ASSERT_EQ(image.width, kWidth);
        const Comparison comparison = compareWithClosedForm(image);
        EXPECT_GE(comparison.tiles, 15);
        EXPECT_LT(comparison.worstTile, 0.01) << backend << ": 13,824 samples a tile";
        EXPECT_LT(std::abs(comparison.mean), 0.01) << backend;
        std::printf("%s: %d tiles, worst %.2f %%, mean %+.3f %%\n", backend, comparison.tiles,
                    100 * comparison.worstTile, 100 * comparison.mean);
    }
}

double meanOf(const FloatImage& image) {
    double sum = 0;
    for (const float value : image.rgb)
        sum += value;
    return sum / static_cast<double>(image.rgb.size());
}

TEST_F(RoomTest, MethodsOfChoiceAgree) {
    const double all = meanOf(render("compute", threeClusterCorridor::kName, 48, {{"rt_numRandomDL", "0"}}));
    ASSERT_GT(all, 0);
    for (const char* cull : {"0", "1"})
        for (const char* count : {"1", "4"}) {
            const double got = meanOf(render("compute", threeClusterCorridor::kName, 96,
                                             {{"rt_numRandomDL", count}, {"rt_cullLights", cull}}));
            EXPECT_NEAR(got / all, 1, 0.01) << "rt_cullLights " << cull << " rt_numRandomDL " << count;
        }
}

TEST_F(RoomTest, FixedSeedRepeatsBitForBit) {
    const FloatImage first = render("compute", squareLightRoom::kName, 3);
    const FloatImage second = render("compute", squareLightRoom::kName, 3);
    const FloatImage other = render("compute", squareLightRoom::kName, 3, {{"rt_seed", "1"}});
    EXPECT_EQ(first.rgb, second.rgb);
    EXPECT_NE(first.rgb, other.rgb);
}

} // namespace
} // namespace q3rt
