// Tables, waves and noise against the formulas and the bytes measured on the original.
#include "scene/wave.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace q3rt {
namespace {

int toByte(double value) { return static_cast<int>(255.0 * value); }

TEST(Wave, SineTableHasThePeriodOf1023) {
    for (int i = 0; i < 1024; ++i)
        EXPECT_EQ(sineTable(i), static_cast<float>(std::sin(2 * std::numbers::pi * i / 1023))) << i;
    EXPECT_NEAR(sineTable(256), 0.9999988, 1e-7);
    EXPECT_EQ(sineTable(1024), sineTable(0));
    EXPECT_EQ(sineTable(-1), sineTable(1023));
}

TEST(Wave, TablesFollowTheirFormulas) {
    for (int i = 0; i < 1024; ++i) {
        EXPECT_EQ(waveTable(WaveFunction::Square, i), i < 512 ? 1 : -1);
        EXPECT_EQ(waveTable(WaveFunction::Sawtooth, i), i / 1024.0);
        EXPECT_EQ(waveTable(WaveFunction::InverseSawtooth, i), 1 - i / 1024.0);
        const double rise = (i & 511) < 256 ? (i & 511) / 256.0 : 1 - ((i & 511) - 256) / 256.0;
        EXPECT_EQ(waveTable(WaveFunction::Triangle, i), i < 512 ? rise : -rise);
    }
}

// Bytes read from the original's pictures at T = 1, 1.1, 1.25, 1.6 of "<function> 0.5 0.5 0 1" (saws: "0 1 0 1").
TEST(Wave, AgreesWithTheOriginalsBytes) {
    const double times[4] = {1, 1.1, 1.25, 1.6};
    const int sine[4] = {127, 202, 254, 52}, saw[4] = {0, 25, 63, 152}, inverse[4] = {255, 229, 191, 102};
    for (int k = 0; k < 4; ++k) {
        EXPECT_EQ(toByte(evaluateWave({WaveFunction::Sin, 0.5f, 0.5f, 0, 1}, times[k])), sine[k]);
        EXPECT_EQ(toByte(evaluateWave({WaveFunction::Sawtooth, 0, 1, 0, 1}, times[k])), saw[k]);
        EXPECT_EQ(toByte(evaluateWave({WaveFunction::InverseSawtooth, 0, 1, 0, 1}, times[k])), inverse[k]);
    }
}

TEST(Wave, NegativeArgumentsTruncateTowardZero) {
    // Cell 0 is twice as wide around 0: -0.0005 * 1024 truncates to 0, -0.0015 * 1024 to -1 = cell 1023.
    EXPECT_EQ(evaluateWave({WaveFunction::Sawtooth, 0, 1, -0.0005f, 0}, 0), 0);
    EXPECT_EQ(evaluateWave({WaveFunction::Sawtooth, 0, 1, -0.0015f, 0}, 0), 1023 / 1024.0);
}

TEST(Wave, KeepsItsPrecisionForWeeks) {
    const double threeWeeks = 21 * 86400.0;
    const Wave wave{WaveFunction::Sawtooth, 0, 1, 0, 1};
    for (int i = 0; i < 1024; ++i)
        EXPECT_EQ(evaluateWave(wave, threeWeeks + (i + 0.5) / 1024), i / 1024.0) << i;
    EXPECT_TRUE(std::isfinite(evaluateWave({WaveFunction::Sin, 0, 1, 3e38f, 3e38f}, 1e30)));
}

TEST(Noise, InterpolatesBetweenLatticePointsWithinItsRange) {
    int checked = 0;
    for (int i = -300; i < 300; ++i) {
        const double x = i * 0.37, t = i * 0.61;
        const double low = std::floor(x), weight = x - low;
        const double left = latticeNoise(low, 3, -2, t), right = latticeNoise(low + 1, 3, -2, t);
        EXPECT_NEAR(latticeNoise(x, 3, -2, t), left + (right - left) * weight, 1e-12);
        EXPECT_LE(std::abs(left), 1.0);
        EXPECT_EQ(latticeNoise(low + 256, 3, -2, std::floor(t)), latticeNoise(low, 3, -2, std::floor(t)));
        ++checked;
    }
    EXPECT_EQ(checked, 600);
}

TEST(Noise, FollowsTheCGenerator) {
    std::srand(1);
    seedNoiseFromCRand();
    // The lattice point (0, 0, 0, 0) by the original's rule, from an own copy of the same draws.
    std::srand(1);
    float value[256];
    int permutation[256];
    for (int i = 0; i < 256; ++i) {
        value[i] = static_cast<float>(std::rand() / static_cast<float>(RAND_MAX) * 2.0 - 1.0);
        permutation[i] = static_cast<int>(std::rand() / static_cast<float>(RAND_MAX) * 255.0f);
    }
    for (int t = 0; t < 256; ++t) {
        const int index = permutation[permutation[permutation[permutation[t]]]];
        EXPECT_EQ(latticeNoise(0, 0, 0, t), value[index]);
    }
    const int index = permutation[(5 + permutation[(6 + permutation[(7 + permutation[8]) & 255]) & 255]) & 255];
    EXPECT_EQ(latticeNoise(5, 6, 7, 8), value[index]);
    EXPECT_EQ(evaluateWave({WaveFunction::Noise, 0.5f, 2, 1, 3}, 4), 0.5 + 2 * latticeNoise(0, 0, 0, 15));
}

} // namespace
} // namespace q3rt
