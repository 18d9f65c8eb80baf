// A million frames in one mean, and colours that come back as they were.

#include <cmath>
#include <random>

#include "denoiser/shader_text.hpp"
#include "numerics/measured.hpp"

namespace q3rt::test {
namespace {

constexpr int kFrames = 1'000'000;
constexpr double kRoundoff = 0x1p-24;

/// What a pixel may get: nearly always nothing and once in a thousand frames a thousand, everything alike, anything.
vec3 sampleOf(std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(0, 1);
    return {uniform(random) < 0.001f ? 1000.0f : 1e-3f, 1.0f / 3, uniform(random)};
}

TEST(Sums, AMillionFramesKeepTheirPrecision) {
    double worst = 0, plainWorst = 0;
    for (const float scale : {1e-6f, 1.0f, 1e6f}) {
        std::mt19937 random(7);
        vec3 sum(0), low(0), mean(0);
        glm::dvec3 exact(0);
        for (int n = 1; n <= kFrames; ++n) {
            const vec3 value = scale * sampleOf(random);
            shader::addCompensated(sum, low, value);
            mean += (value - mean) / static_cast<float>(n);
            exact += glm::dvec3(value);
        }
        for (int k = 0; k < 3; ++k) {
            const double expected = exact[k] / kFrames;
            worst = std::max(worst, std::abs(double(sum[k] / float(kFrames)) / expected - 1));
            plainWorst = std::max(plainWorst, std::abs(double(mean[k]) / expected - 1));
        }
    }
    // Sum and division: 2 u each; the sum's own second-order term is n u^2.
    expectWithin("mean of 1,000,000 frames", worst, 4 * kRoundoff + kFrames * kRoundoff * kRoundoff, "relative");
    EXPECT_GT(plainWorst, 4 * kRoundoff) << "a running mean would do";
    std::printf("numerics | the same as a running mean | %.2g\n", plainWorst);
}

/// A sum that is large does not stop to grow: what a frame adds is kept, however little.
TEST(Sums, DoNotStall) {
    size_t stalled = 0, cases = 0;
    for (const float sum0 : {1e3f, 1e6f, 1e9f})
        for (const float share : {1e-7f, 1e-9f}) {
            vec3 sum(sum0), low(0);
            const float value = share * sum0;
            for (int n = 0; n < kFrames; ++n)
                shader::addCompensated(sum, low, vec3(value));
            const double grown = double(sum.x) - double(low.x) - double(sum0);
            stalled += std::abs(grown / (double(value) * kFrames) - 1) > 1e-3;
            ++cases;
        }
    expectCount("sums that stall at terms of 1e-7 and 1e-9 of them", stalled, cases);
}

TEST(Colors, All256SrgbValuesComeBack) {
    size_t wrong = 0;
    float before = -1;
    for (int i = 0; i < 256; ++i) {
        const float light = shader::linearFromSrgb(static_cast<float>(i) / 255);
        wrong += std::lround(255 * shader::srgbFromLinear(light)) != i || !(light > before);
        before = light;
    }
    expectCount("sRGB values that don't come back, or fall", wrong, 256);
}

} // namespace
} // namespace q3rt::test
