// A fixed seed gives the same frames bit for bit, run for run, on one device; across devices within a tolerance.

#include <cstdlib>

#include <gtest/gtest.h>

#include "formats/image.hpp"
#include "host/common/file_bytes.hpp"
#include "metrics/image_metrics.hpp"
#include "numerics/measured.hpp"
#include "numerics/renderer/rooms.hpp"

namespace q3rt::test {
namespace {

constexpr int kWidth = 96, kHeight = 72; ///< pixels

/// The last of 12 frames of a camera that moves through the corridor with all that remembers earlier frames.
HostFrame drawWalk(FileSource& game, const char* backend) {
    TraceHarness harness(game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    harness.engine().showsMessages = false;
    harness.set("rt_backend", backend);
    harness.set("rt_denoiser", "1");
    harness.set("rt_taa", "1");
    harness.set("rt_antialiasing", "1");
    harness.loadMap(std::string("maps/") + threeClusterCorridor::kName + ".bsp");
    harness.setLights({{{480, 200, 60}, 150}});
    HostFrame frame;
    for (int i = 0; i < 12; ++i) {
        const auto at = static_cast<float>(i);
        frame = harness.picture({.eye = {20 + 4 * at, 60, 100}, .yaw = 35 - at, .timeMs = 16 * i}, 1);
    }
    return frame;
}

TEST(Repeats, AreTheSameBitForBit) {
    TestGame game;
    size_t different = 0, cases = 0;
    for (const char* backend : {"compute", "query", "pipeline"}) {
        const HostFrame first = drawWalk(game, backend), second = drawWalk(game, backend);
        ++cases;
        different += first.rgb != second.rgb;
    }
    expectCount("walks of 12 frames that differ from run to run", different, cases);
}

/// Against the picture in the repository, which lavapipe made: Q3RT_UPDATE_GOLDEN=1 makes it anew.
TEST(Repeats, AgreeAcrossDevices) {
    TestGame game;
    const HostFrame frame = drawWalk(game, "compute");
    const std::string path = Q3RT_SOURCE_DIR "/tests/numerics/renderer/walk.png";
    if (std::getenv("Q3RT_UPDATE_GOLDEN")) writeFileBytes(path, encodePng(frame.width, frame.height, 3, frame.rgb));
    const Image stored = decodeImage(readFileBytes(path), path);
    const MetricImage reference = metricImageFromBytes(stored.width, stored.height, 4, stored.rgba);
    const MetricImage test = metricImageFromBytes(frame.width, frame.height, 3, frame.rgb);
    expectWithin("a walk of 12 frames on this device against the stored picture, 1 - SSIM",
                 1 - computeSsim(reference, test).mean, 0.01, "");
}

} // namespace
} // namespace q3rt::test
