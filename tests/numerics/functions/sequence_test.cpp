// Random numbers where counters are large and where they begin again.

#include <algorithm>
#include <cmath>
#include <vector>

#include "numerics/measured.hpp"
#include "tracer/shader_text.hpp"

namespace q3rt::test {
namespace {

constexpr uint32_t kSide = 64; ///< pixels

/// The numbers of all pixels in one frame.
std::vector<vec4> numbersOf(uint32_t frame, uint32_t dimension) {
    std::vector<vec4> result;
    for (uint32_t i = 0; i < kSide * kSide; ++i)
        result.push_back(shader::randomNumbers(glm::uvec4(i % kSide, i / kSide, frame, 0), dimension));
    return result;
}

double correlationOf(const std::vector<vec4>& a, const std::vector<vec4>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += (double(a[i].x) - 0.5) * (double(b[i].x) - 0.5);
    return 12 * sum / static_cast<double>(a.size()); // the variance of [0, 1) is 1/12
}

/// Frames around the borders of their 32-bit counter; it begins again after 2^32.
std::vector<uint32_t> framesAtBorders() {
    std::vector<uint32_t> frames;
    for (const uint32_t border : {0u, 1u << 24, 1u << 31})
        for (uint32_t i = 0; i < 8; ++i)
            frames.push_back(border + i - 4);
    return frames;
}

TEST(Sequences, NumbersStayUniformAcrossTheCountersBorders) {
    double worst = 0;
    for (const uint32_t frame : framesAtBorders())
        for (const uint32_t dimension : {0u, 16u, 20000u, 1280016u}) {
            dvec3 sum(0);
            for (const vec4& r : numbersOf(frame, dimension))
                sum += dvec3(r);
            const double error = 0.28868 / kSide; // of a mean of kSide^2 numbers
            for (int k = 0; k < 3; ++k)
                worst = std::max(worst, std::abs(sum[k] / (kSide * kSide) - 0.5) / error);
        }
    // 288 means: beyond 4.5 with probability 0.002.
    expectWithin("means of a frame's numbers, counters across 2^24, 2^31, 2^32", worst, 4.5, "standard errors");
}

TEST(Sequences, FramesAreUnrelatedAcrossTheCountersBorders) {
    const std::vector<uint32_t> frames = framesAtBorders();
    double worst = 0;
    for (size_t i = 0; i < frames.size(); ++i)
        for (const uint32_t apart : {1u, 2u, 3u, 64u, 1u << 16, 1u << 24, 1u << 29})
            worst =
                std::max(worst, std::abs(correlationOf(numbersOf(frames[i], 16), numbersOf(frames[i] + apart, 16))));
    // 168 pairs of 4,096 pixels: one standard error is 1/64.
    expectWithin("correlation of frames up to 2^29 apart, across 2^24, 2^31, 2^32", worst, 4.5 / kSide, "");
    // Where it begins to fail: the hash carries the counter's highest bits too little. 2^30 frames are 124 days at 100
    // frames a second.
    std::printf("numerics | correlation of frames 2^30 and 2^31 apart | %.2g, %.2g\n",
                correlationOf(numbersOf(5, 16), numbersOf(5 + (1u << 30), 16)),
                correlationOf(numbersOf(5, 16), numbersOf(5 + (1u << 31), 16)));
}

TEST(Sequences, NoFrameComesAgainWithinThePeriod) {
    const std::vector<vec4> first = numbersOf(5, 16);
    size_t same = 0, cases = 0;
    for (uint32_t bit = 0; bit < 32; ++bit, ++cases)
        same += numbersOf(5u ^ (1u << bit), 16) == first;
    expectCount("frames that repeat an earlier one's numbers", same, cases);
}

/// Numbers are whole multiples of 2^-24: 1 never comes, 0 does.
TEST(Sequences, NumbersStayBelowOne) {
    float largest = 0;
    for (const uint32_t frame : framesAtBorders())
        for (const vec4& r : numbersOf(frame, 3))
            largest = std::max({largest, r.x, r.y, r.z, r.w});
    EXPECT_LT(largest, 1.0f);
    EXPECT_EQ(shader::unitFloat(0xffffffffu), 1.0f - 0x1p-24f);
    EXPECT_EQ(shader::unitFloat(0u), 0.0f);
}

} // namespace
} // namespace q3rt::test
