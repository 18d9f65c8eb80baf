// The denoiser on OpenArena's maps: it neither adds light nor takes any, and a cut starts it anew.

#include <cstdlib>
#include <gtest/gtest.h>

#include "host/still/map_stage.hpp"
#include "metrics/image_metrics.hpp"
#include "picture_tools.hpp"
#include "support/game_data.hpp"

namespace q3rt {
namespace {

using test::Camera;
using test::meanOf;
using test::TraceHarness;

constexpr int kWidth = 96, kHeight = 72; ///< pixels
constexpr int kFrames = 48;

Camera cameraAt(const MapStage& stage, const char* place) {
    const EyePoint eye = stage.findEye(place);
    return {.eye = eye.origin, .pitch = eye.pitchDegrees, .yaw = eye.yawDegrees};
}

std::unique_ptr<TraceHarness> openMap(Pk3FileSource& files, const MapStage& stage, const char* denoiser) {
    auto harness = std::make_unique<TraceHarness>(files, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    harness->set("rt_denoiser", denoiser);
    harness->loadMap(stage.file());
    return harness;
}

TEST(DenoisedMaps, KeepTheMeanOfTheirLight) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    std::vector<const char*> maps{"oa_shouse", "fan"};
    if (std::getenv("Q3RT_LONG_TESTS")) maps.insert(maps.end(), {"oa_dm1", "oacmpdm9", "hydronex"});
    for (const char* map : maps) {
        const MapStage stage(*files, map);
        const Camera camera = cameraAt(stage, "spawn:0");
        double denoised = 0;
        {
            const auto harness = openMap(*files, stage, "1");
            for (int i = 0; i < kFrames; ++i)
                denoised += meanOf(harness->radiance(camera, 1)) / kFrames;
        }
        const auto harness = openMap(*files, stage, "0");
        harness->set("rt_accumulate", "1");
        // The same numbers of frames: most of their samples are the same ones.
        const double plain = meanOf(harness->radiance(camera, kFrames));
        std::printf("%s: energy %+.2f %%\n", map, 100 * (denoised / plain - 1));
        EXPECT_NEAR(denoised / plain, 1, 0.01) << map;
    }
}

TEST(DenoisedMaps, ACutShowsNothingOfTheOldView) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const MapStage stage(*files, "oa_dm1");
    const Camera here = cameraAt(stage, "spawn:0"), elsewhere = cameraAt(stage, "spawn:3");
    ASSERT_GT(glm::distance(here.eye, elsewhere.eye), 256);
    constexpr int kBefore = 8;
    const auto pictureOf = [&](const char* before, bool jumps) {
        // Both have drawn as many frames, so that their samples are the same ones.
        const auto harness = openMap(*files, stage, before);
        harness->draw(jumps ? here : elsewhere, kBefore);
        harness->set("rt_denoiser", "1");
        const HostFrame picture = harness->picture(elsewhere, 1);
        return metricImageFromBytes(picture.width, picture.height, 3, picture.rgb);
    };
    const double ssim = computeSsim(pictureOf("0", false), pictureOf("1", true)).mean;
    std::printf("first frame after a cut: SSIM %.4f to a denoiser that has just started\n", ssim);
    EXPECT_GE(ssim, 0.95);
}

} // namespace
} // namespace q3rt
