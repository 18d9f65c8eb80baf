// The same converged picture whatever lights are tried and however many are chosen: on tiles of 8 x 8 pixels within 4
// standard errors, in total luminance within 0.2 %.

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

#include "support/game_data.hpp"
#include "truth/picture_statistics.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

constexpr int kSeeds = 8;
constexpr double kBeyondAllowed = 0.001; ///< share of the tiles
constexpr double kLuminanceTolerance = 0.002;

struct Method {
    const char *cullLights, *numRandomDL, *lightCandidates;
    int frames; ///< for each seed
};

class MethodPictures {
  public:
    MethodPictures(FileSource& files, const std::string& map, const Camera& camera, int width, int height)
        : m_map(map)
        , m_camera(camera)
        , m_harness(files, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", width, height) {
        prepareHarness(m_harness, map, {});
    }

    /// The first call makes the picture that later ones are held against.
    void check(const Method& method) {
        m_harness.set("rt_cullLights", method.cullLights);
        m_harness.set("rt_numRandomDL", method.numRandomDL);
        m_harness.set("rt_lightCandidates", method.lightCandidates);
        const MeasuredPicture picture =
            measurePicture(m_harness, m_camera, kSeeds, method.frames, 1 + kSeeds * m_methods++);
        if (!m_first) {
            m_first = picture;
            return;
        }
        const TileComparison got = compareTiles(*m_first, picture);
        const std::string name = m_map + ", rt_cullLights " + method.cullLights + ", rt_numRandomDL " +
                                 method.numRandomDL + ", rt_lightCandidates " + method.lightCandidates;
        std::printf("%s: %zu tiles, %zu beyond 4 standard errors, worst %.2f; luminance %+.3f %% +- %.3f %%\n",
                    name.c_str(), got.tiles, got.beyond, got.worst, 100 * (got.luminanceRatio - 1),
                    100 * got.luminanceError);
        EXPECT_LE(double(got.beyond), kBeyondAllowed * double(got.tiles)) << name;
        EXPECT_LE(std::abs(got.luminanceRatio - 1), kLuminanceTolerance) << name;
        EXPECT_LE(2 * got.luminanceError, kLuminanceTolerance) << name << ": too few samples to say anything";
    }

  private:
    std::string m_map;
    Camera m_camera;
    TraceHarness m_harness;
    std::optional<MeasuredPicture> m_first;
    int m_methods = 0;
};

TEST(Methods, ShowTheSameRoom) {
    TestGame game;
    MethodPictures room(game, squareLightRoom::kName, {.eye = {-200, -180, 100}, .pitch = 10, .yaw = 40}, 64, 48);
    room.check({"0", "0", "16", 32});
    for (const Method& method : {Method{"1", "0", "16", 32}, {"1", "1", "16", 64}, {"1", "4", "1", 32}})
        room.check(method);
}

/// From one end of the corridor and from its middle: what one cluster can't see, another can.
TEST(Methods, ShowTheSameCorridor) {
    TestGame game;
    for (const Camera& camera : {Camera{.eye = {20, 20, 100}, .yaw = 35}, Camera{.eye = {480, 130, 100}, .yaw = 90}}) {
        MethodPictures corridor(game, threeClusterCorridor::kName, camera, 64, 48);
        corridor.check({"0", "0", "16", 32});
        for (const Method& method : {Method{"1", "0", "16", 32}, {"0", "1", "16", 64}, {"1", "4", "16", 32}})
            corridor.check(method);
    }
}

TEST(Methods, ShowTheSameFan) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    MethodPictures fan(*files, "fan", {.eye = {-736, 0, 122}, .pitch = -5, .yaw = 0}, 64, 48);
    fan.check({"0", "0", "16", 9});
    for (const Method& method : {Method{"1", "1", "16", 160}, {"1", "4", "16", 48}})
        fan.check(method);
}

} // namespace
} // namespace q3rt::test
