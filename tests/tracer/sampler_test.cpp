// The samples of a pixel: even over frames, uniform over seeds, blue over the picture.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>

#include "renderer_rt/blue_noise/void_and_cluster.hpp"
#include "shader_text.hpp"
#include "shaders/shared/rt_noise.h"

namespace q3rt::shader {
namespace {
#include "lib/low_discrepancy.glsl"
} // namespace
} // namespace q3rt::shader

namespace q3rt {
namespace {

glm::uvec3 seedsOf(uint32_t i) {
    const glm::uvec4 h = shader::hashPcg4d(glm::uvec4(i, 3, 5, 7));
    return {h.x, h.y, h.z};
}

/// Every interval of a (0, m, 2)-net in base 2 holds its one point of the first 2^m.
TEST(LowDiscrepancy, FillsEveryElementaryInterval) {
    int checked = 0;
    for (uint32_t set = 0; set < 20; ++set)
        for (const uint32_t m : {4u, 8u})
            for (uint32_t split = 0; split <= m; ++split, ++checked) {
                std::vector<int> hits(1u << m, 0);
                for (uint32_t i = 0; i < 1u << m; ++i) {
                    const glm::uvec2 p = shader::lowDiscrepancyPoint(i, seedsOf(set));
                    const uint64_t column = uint64_t{p.x} >> (32 - split), row = uint64_t{p.y} >> (32 - (m - split));
                    ++hits[static_cast<size_t>(column << (m - split) | row)];
                }
                ASSERT_EQ(*std::max_element(hits.begin(), hits.end()), 1) << "set " << set << ", 2^" << split;
            }
    EXPECT_EQ(checked, 20 * (5 + 9));
}

/// Any point of the sequence is uniform over the seeds: the mean over seeds is exact, whatever the frame.
TEST(LowDiscrepancy, EachPointIsUniformOverTheSeeds) {
    constexpr uint32_t kSeeds = 1 << 14;
    for (const uint32_t index : {0u, 1u, 77u, 100000u}) {
        double x = 0, y = 0, xy = 0, xx = 0;
        for (uint32_t seed = 0; seed < kSeeds; ++seed) {
            const glm::uvec2 p = shader::lowDiscrepancyPoint(index, seedsOf(seed));
            const double u = p.x * 0x1p-32, v = p.y * 0x1p-32;
            x += u / kSeeds;
            y += v / kSeeds;
            xy += u * v / kSeeds;
            xx += u * u / kSeeds;
        }
        const double bound = 5 * 0.2887 / 128; // 5 standard errors
        EXPECT_NEAR(x, 0.5, bound);
        EXPECT_NEAR(y, 0.5, bound);
        EXPECT_NEAR(xy, 0.25, bound);
        EXPECT_NEAR(xx, 1.0 / 3, bound);
    }
}

/// Root mean square error of the mean of a function with an edge after `count` numbers, over many seeds.
double errorOf(uint32_t count, bool even) {
    constexpr uint32_t kSeeds = 400;
    double sum = 0;
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        double mean = 0;
        for (uint32_t i = 0; i < count; ++i) {
            const glm::uvec4 h = shader::hashPcg4d(glm::uvec4(i, seed, 1, 2));
            const glm::uvec2 p = even ? shader::lowDiscrepancyPoint(i, seedsOf(seed)) : glm::uvec2(h.x, h.y);
            const double u = p.x * 0x1p-32, v = p.y * 0x1p-32;
            mean += (u * u + v * v < 0.7 ? 1 + u : 0) / count;
        }
        const auto exact = [] {
            // Quarter disc of radius r: area + its first moment.
            const double r = std::sqrt(0.7);
            return std::numbers::pi * r * r / 4 + r * r * r / 3;
        };
        sum += (mean - exact()) * (mean - exact());
    }
    return std::sqrt(sum / kSeeds);
}

TEST(LowDiscrepancy, ErrsLessThanTheHashAtEqualSamples) {
    for (const uint32_t count : {4u, 16u, 64u, 256u}) {
        const double hash = errorOf(count, false), even = errorOf(count, true);
        std::printf("%u samples: hash %.4f, low discrepancy %.4f\n", count, hash, even);
        EXPECT_LT(even, hash * (count < 16 ? 0.8 : 0.5));
    }
}

TEST(BlueNoise, HoldsEveryRankOnce) {
    std::vector<uint16_t> ranks = makeBlueNoise(kBlueNoiseSide, 1);
    EXPECT_EQ(ranks, makeBlueNoise(kBlueNoiseSide, 1));
    EXPECT_NE(ranks, makeBlueNoise(kBlueNoiseSide, 2));
    ASSERT_EQ(ranks.size(), size_t{1} << kBlueNoiseBits);
    std::sort(ranks.begin(), ranks.end());
    for (size_t i = 0; i < ranks.size(); ++i)
        ASSERT_EQ(ranks[i], i);
}

TEST(BlueNoise, HasNoLowFrequencies) {
    constexpr int kSide = static_cast<int>(kBlueNoiseSide);
    const std::vector<uint16_t> ranks = makeBlueNoise(kBlueNoiseSide, 3);
    // Mean power of the waves up to a quarter of the highest frequency, over that of independent numbers.
    double power = 0;
    int waves = 0;
    for (int fy = -8; fy <= 8; ++fy)
        for (int fx = 0; fx <= 8; ++fx) {
            if (fx * fx + fy * fy > 64 || (fx == 0 && fy <= 0)) continue;
            std::complex<double> sum = 0;
            for (int i = 0; i < kSide * kSide; ++i) {
                const double angle = 2 * std::numbers::pi * (fx * (i % kSide) + fy * (i / kSide)) / kSide;
                sum += std::polar((ranks[static_cast<size_t>(i)] + 0.5) / (kSide * kSide) - 0.5, angle);
            }
            power += std::norm(sum) / (kSide * kSide / 12.0);
            ++waves;
        }
    std::printf("low frequencies hold %.4f of white noise's power\n", power / waves);
    EXPECT_LT(power / waves, 0.02);
}

} // namespace
} // namespace q3rt
