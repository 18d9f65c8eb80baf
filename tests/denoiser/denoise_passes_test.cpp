// What the denoiser must do with light that the test knows: keep what has no noise, keep the mean, forget what changes.

#include <cmath>
#include <limits>

#include "denoise_rig.hpp"
#include "tests/gpu/gpu_test.hpp"

namespace q3rt {
namespace {

using test::DenoiseRig;
using test::kRigExtent;
using test::kRigPixelCount;
using test::meanLuminance;
using test::RigFrame;

class DenoisePassesTest : public GpuTest {};

const vec3 kEye{0, 0, 64};

/// Hard-edged squares, and a slow slope across them.
vec3 patternAt(const RtPixel& pixel) {
    const vec3& p = pixel.position;
    const int square =
        static_cast<int>(std::floor(p.x / 32 + 0.13f) + std::floor(p.y / 32 + 0.27f) + std::floor(p.z / 32 + 0.41f));
    return (square & 1 ? vec3(1.0f, 0.75f, 0.5f) : vec3(0.125f)) * (1 + p.y / 2048);
}

/// One of four lights shows at random by the pixel's own key: the mean is 1.
float chanceOf(const RtPixel& pixel) {
    uint32_t h = pixel.keyPixel * 2654435761u ^ (pixel.keyFrame + 0x9e3779b9u) * 2246822519u;
    h = (h ^ h >> 15) * 2246822519u;
    h = (h ^ h >> 13) * 3266489917u;
    h ^= h >> 16;
    return h < 0x40000000u ? 4.0f : 0.0f;
}

vec3 noisyLight(const RtPixel& pixel) { return vec3(chanceOf(pixel)); }

bool allFinite(const std::vector<vec3>& light) {
    for (const vec3& v : light)
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
    return true;
}

TEST_F(DenoisePassesTest, CarriesSamplesBitForBit) {
    DenoiseRig rig(device());
    EXPECT_EQ(rig.draw(kEye, noisyLight).carriedCount, 0u) << "there is no frame before the first";
    const RigFrame before = rig.draw(kEye, noisyLight);
    const RigFrame after = rig.draw(kEye, noisyLight);
    uint32_t found = 0;
    for (size_t i = 0; i < kRigPixelCount; ++i) {
        const RtPixel& pixel = after.pixels[i];
        if (pixel.keyFrame != before.pixels[i].keyFrame || pixel.keyPixel != before.pixels[i].keyPixel) continue;
        ++found;
        EXPECT_EQ(pixel.position, before.pixels[i].position);
        EXPECT_EQ(after.traced[i], before.traced[i]);
    }
    EXPECT_EQ(found, after.carriedCount) << "the camera stands: each sample stays in its pixel";
    const VkExtent2D strata = strataOf(kRigExtent);
    EXPECT_GT(after.carriedCount, strata.width * strata.height * 7 / 10);
    EXPECT_LE(after.carriedCount, strata.width * strata.height);
}

TEST_F(DenoisePassesTest, LightWithoutNoisePassesUnchanged) {
    for (const DenoiserKind kind : {DenoiserKind::Asvgf, DenoiserKind::Svgf}) {
        DenoiseRig rig(device(), kind);
        RigFrame frame;
        for (int i = 0; i < 8; ++i)
            frame = rig.draw(kEye, patternAt);
        float worst = 0;
        for (size_t i = 0; i < kRigPixelCount; ++i)
            for (int k = 0; k < 3; ++k)
                worst = std::max(worst, std::abs(frame.shown[i][k] - frame.traced[i][k]));
        EXPECT_LE(worst, 1.0f / 255) << kRigPixelCount << " pixels";
        std::printf("largest change of light without noise: %.5f\n", static_cast<double>(worst));
    }
}

TEST_F(DenoisePassesTest, WithoutGradientsNothingIsCarriedAndLightLags) {
    DenoiseRig rig(device(), DenoiserKind::Svgf);
    for (int i = 0; i < 24; ++i)
        EXPECT_EQ(rig.draw(kEye, noisyLight).carriedCount, 0u);
    RigFrame frame;
    for (int i = 0; i < 4; ++i)
        frame = rig.draw(kEye, [](const RtPixel&) { return vec3(0); });
    EXPECT_NEAR(meanLuminance(frame, frame.shown), std::pow(1 - kFixedShare, 4), 0.05);
}

TEST_F(DenoisePassesTest, KeepsTheMeanAndRemovesTheNoise) {
    DenoiseRig rig(device());
    double traced = 0, shown = 0, error = 0;
    size_t count = 0;
    for (int i = 0; i < 24; ++i) {
        const RigFrame frame = rig.draw(kEye, noisyLight);
        traced += meanLuminance(frame, frame.traced);
        shown += meanLuminance(frame, frame.shown);
        if (i < 23) continue;
        for (size_t p = 0; p < kRigPixelCount; ++p) {
            if (frame.pixels[p].lit == 0) continue;
            error += std::pow(frame.shown[p].x - 1, 2);
            ++count;
        }
    }
    EXPECT_NEAR(shown / traced, 1, 0.01);
    const double deviation = std::sqrt(error / static_cast<double>(count));
    EXPECT_LT(deviation, 0.1) << "of 1.73 a sample";
    std::printf("energy %+.3f %%, deviation after 24 frames %.4f\n", 100 * (shown / traced - 1), deviation);
}

TEST_F(DenoisePassesTest, ForgetsALightThatGoesOut) {
    DenoiseRig rig(device());
    constexpr float kRest = 0.25f; ///< of another light that stays
    const auto lit = [](const RtPixel& pixel) { return vec3(kRest + chanceOf(pixel)); };
    const auto dark = [](const RtPixel&) { return vec3(kRest); };
    for (int i = 0; i < 24; ++i)
        rig.draw(kEye, lit);
    double leftOver = 1;
    for (int i = 0; i < 4; ++i) {
        const RigFrame frame = rig.draw(kEye, dark);
        leftOver = meanLuminance(frame, frame.shown) - static_cast<double>(kRest);
        std::printf("frame %d: %.2f %% of the light are left\n", i + 1, 100 * leftOver);
    }
    EXPECT_LE(leftOver, 0.05);
    EXPECT_GE(leftOver, -0.01);
}

TEST_F(DenoisePassesTest, FollowsAMovingCamera) {
    DenoiseRig rig(device());
    double traced = 0, shown = 0, error = 0;
    size_t count = 0;
    for (int i = 0; i < 24; ++i) {
        const RigFrame frame = rig.draw(kEye + vec3(i * 1.3f, i * 2.1f, i * 0.4f), noisyLight);
        ASSERT_TRUE(allFinite(frame.shown));
        traced += meanLuminance(frame, frame.traced);
        shown += meanLuminance(frame, frame.shown);
        if (i < 23) continue;
        for (size_t p = 0; p < kRigPixelCount; ++p) {
            if (frame.pixels[p].lit == 0) continue;
            error += std::pow(frame.shown[p].x - 1, 2);
            ++count;
        }
        EXPECT_GT(frame.carriedCount, 100u);
    }
    EXPECT_NEAR(shown / traced, 1, 0.01);
    EXPECT_LT(std::sqrt(error / static_cast<double>(count)), 0.2);
}

TEST_F(DenoisePassesTest, NothingThatIsNoNumberGetsIn) {
    DenoiseRig rig(device());
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 6; ++i) {
        const RigFrame frame = rig.draw(kEye, [&](const RtPixel& pixel) {
            if (pixel.keyPixel % 101 == 7) return vec3(nan);
            if (pixel.keyPixel % 103 == 9) return vec3(infinity, 0, 0);
            return vec3(0.5f);
        });
        ASSERT_TRUE(allFinite(frame.shown)) << "frame " << i;
    }
}

TEST_F(DenoisePassesTest, ACutLeavesNothingBehind) {
    DenoiseRig fresh(device()), used(device());
    const auto bright = [](const RtPixel& pixel) { return vec3(5 + chanceOf(pixel)); };
    for (int i = 0; i < 6; ++i) {
        used.draw(kEye, bright);
        fresh.cut();
    }
    used.cut();
    fresh.cut();
    const RigFrame a = used.draw(kEye, patternAt), b = fresh.draw(kEye, patternAt);
    EXPECT_EQ(a.shown, b.shown);
}

TEST_F(DenoisePassesTest, CountsWhatIsNoNumber) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    std::vector<RtGuide> guides(kRigPixelCount);
    for (RtGuide& guide : guides)
        guide.normal = 0x7fc00000u; // packed, not a number
    guides[7].position.x = nan;
    guides[11].position = {infinity, 1, -infinity};
    DenoiseRig rig(device());
    EXPECT_EQ(rig.countNonFinite(guides), 3u);
}

} // namespace
} // namespace q3rt
