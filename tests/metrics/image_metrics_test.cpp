// Expected values of the noisy pair: a straightforward program of our own (Python doubles, full two-dimensional
// kernels, variances about the mean, colour matrices derived from the primaries), which shares no code with the
// library.

#include "metrics/image_metrics.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "test_pictures.hpp"

namespace q3rt::test {

TEST(Ssim, NoisyPairAgreesWithIndependentProgram) {
    const Pair pair = makeNoisyPair();
    const MetricMap map = computeSsim(pair.reference, pair.test);
    EXPECT_EQ(map.width, 30);
    EXPECT_EQ(map.height, 20);
    EXPECT_NEAR(map.mean, 0.9622668973806864, 1e-9);
    EXPECT_NEAR(map.values.front(), 0.9165075495552101, 1e-9);
}

TEST(Ssim, EqualPicturesGiveOneEverywhere) {
    const MetricImage picture = makeNoisyPair().reference;
    for (const double value : computeSsim(picture, picture).values)
        EXPECT_NEAR(value, 1.0, 1e-12);
}

TEST(Ssim, ConstantPicturesHaveClosedForm) {
    // Without variance only the luminance term is left: (2 a b + C1) / (a^2 + b^2 + C1), C1 = 6.5025.
    int cases = 0;
    for (const int a : {0, 10, 128, 255})
        for (const int b : {0, 3, 140, 255}) {
            const double expected = (2.0 * a * b + 6.5025) / (1.0 * a * a + 1.0 * b * b + 6.5025);
            const MetricMap map = computeSsim(makeConstant(12, 11, a / 255.0, a / 255.0, a / 255.0),
                                              makeConstant(12, 11, b / 255.0, b / 255.0, b / 255.0));
            EXPECT_NEAR(map.mean, expected, 1e-9);
            ++cases;
        }
    EXPECT_EQ(cases, 16);
}

TEST(Ssim, IsSymmetricAndNegativeForInvertedPattern) {
    const Pair pair = makeNoisyPair();
    EXPECT_DOUBLE_EQ(computeSsim(pair.reference, pair.test).mean, computeSsim(pair.test, pair.reference).mean);
    MetricImage board{16, 16, {}}, inverted{16, 16, {}};
    for (int i = 0; i < 256; ++i) {
        const double value = (i % 16 + i / 16) % 2;
        board.rgb.insert(board.rgb.end(), 3, value);
        inverted.rgb.insert(inverted.rgb.end(), 3, 1.0 - value);
    }
    EXPECT_LT(computeSsim(board, inverted).mean, -0.9);
}

TEST(Ssim, RefusesSmallAndUnequalSizes) {
    EXPECT_THROW(computeSsim(makeConstant(10, 20, 0, 0, 0), makeConstant(10, 20, 0, 0, 0)), UsageError);
    EXPECT_THROW(computeSsim(makeConstant(12, 20, 0, 0, 0), makeConstant(20, 12, 0, 0, 0)), UsageError);
}

TEST(Flip, NoisyPairAgreesWithIndependentProgram) {
    const Pair pair = makeNoisyPair();
    const MetricMap map = computeFlip(pair.reference, pair.test);
    // The library's colour matrix has eight decimals.
    EXPECT_NEAR(map.mean, 0.11734198362699229, 1e-6);
    EXPECT_NEAR(map.values.front(), 0.1684681756785818, 1e-6);
    EXPECT_NEAR(*std::max_element(map.values.begin(), map.values.end()), 0.2879655396786997, 1e-6);
    EXPECT_NEAR(computeFlip(pair.reference, pair.test, 20).mean, 0.23531195865997498, 1e-6);
}

TEST(Flip, EqualPicturesGiveZeroEverywhere) {
    const MetricImage picture = makeNoisyPair().reference;
    for (const double value : computeFlip(picture, picture).values)
        EXPECT_EQ(value, 0.0);
}

TEST(Flip, ConstantPicturesHaveClosedForm) {
    // No features: the redistributed colour difference alone. Black against white: HyAB distance 100.
    EXPECT_NEAR(computeFlip(makeConstant(5, 4, 0, 0, 0), makeConstant(5, 4, 1, 1, 1)).mean, 0.9673791815541143, 1e-6);
    // Green against blue is the largest difference there is.
    EXPECT_NEAR(computeFlip(makeConstant(5, 4, 0, 1, 0), makeConstant(5, 4, 0, 0, 1)).mean, 1.0, 1e-12);
    EXPECT_NEAR(computeFlip(makeConstant(5, 4, 100 / 255.0, 100 / 255.0, 100 / 255.0),
                            makeConstant(5, 4, 110 / 255.0, 110 / 255.0, 110 / 255.0))
                    .mean,
                0.15345881416559976, 1e-6);
}

TEST(Flip, IsSymmetricAndStaysInRange) {
    const Pair pair = makeNoisyPair();
    const MetricMap forward = computeFlip(pair.reference, pair.test), backward = computeFlip(pair.test, pair.reference);
    for (size_t i = 0; i < forward.values.size(); ++i) {
        EXPECT_NEAR(forward.values[i], backward.values[i], 1e-12);
        EXPECT_GE(forward.values[i], 0.0);
        EXPECT_LE(forward.values[i], 1.0);
    }
    EXPECT_EQ(forward.values.size(), 1200u);
}

TEST(Errors, NoisyPairAgreesWithIndependentProgram) {
    const Pair pair = makeNoisyPair();
    EXPECT_NEAR(computeMse(pair.reference, pair.test), 0.001962980050407959, 1e-15);
    EXPECT_NEAR(computePsnr(pair.reference, pair.test), 27.07084114073843, 1e-10);
    EXPECT_NEAR(computeRelativeMse(pair.reference, pair.test), 0.03260087000844875, 1e-14);
}

TEST(Errors, ConstantOffsetHasClosedForm) {
    const MetricImage half = makeConstant(3, 2, 0.5, 0.5, 0.5), more = makeConstant(3, 2, 0.6, 0.6, 0.6);
    EXPECT_NEAR(computeMse(half, more), 0.01, 1e-15);
    EXPECT_NEAR(computePsnr(half, more), 20.0, 1e-12);
    EXPECT_NEAR(computeRelativeMse(half, more), 0.01 / 0.26, 1e-15);
    EXPECT_EQ(computeMse(half, half), 0.0);
    EXPECT_TRUE(std::isinf(computePsnr(half, half)));
}

TEST(MetricImages, BytesFloatsAndBadInput) {
    const std::vector<uint8_t> rgba{255, 0, 51, 9};
    const MetricImage image = metricImageFromBytes(1, 1, 4, rgba);
    EXPECT_EQ(image.rgb, (std::vector<double>{1.0, 0.0, 0.2}));
    EXPECT_THROW(metricImageFromBytes(2, 1, 4, rgba), UsageError);
    EXPECT_THROW(metricImageFromBytes(1, 1, 2, rgba), UsageError);
    const std::vector<float> floats{-1.0f, 0.5f, 4.0f}, bad{0.0f, std::nanf(""), 0.0f};
    EXPECT_EQ(clampToDisplay(metricImageFromFloats(1, 1, floats)).rgb, (std::vector<double>{0.0, 0.5, 1.0}));
    EXPECT_THROW(metricImageFromFloats(1, 1, bad), ContentError);
    EXPECT_THROW(computeMse(makeConstant(0, 0, 0, 0, 0), makeConstant(0, 0, 0, 0, 0)), UsageError);
}

} // namespace q3rt::test
