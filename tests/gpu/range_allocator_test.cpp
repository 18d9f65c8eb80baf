// Sub-allocation without a GPU.

#include <map>
#include <random>

#include <gtest/gtest.h>

#include "gpu/range_allocator.hpp"

namespace q3rt {
namespace {

TEST(RangeAllocator, AlignsAndFillsToTheLastByte) {
    RangeAllocator ranges(256);
    EXPECT_EQ(ranges.allocate(1, 1), 0u);
    EXPECT_EQ(ranges.allocate(64, 64), 64u);
    EXPECT_EQ(ranges.allocate(63, 1), 1u); // the gap before the aligned one, exactly
    EXPECT_EQ(ranges.allocate(128, 128), 128u);
    EXPECT_EQ(ranges.allocate(1, 1), std::nullopt);
    EXPECT_EQ(ranges.used(), 256u);
}

TEST(RangeAllocator, HolesJoinAgain) {
    RangeAllocator ranges(300);
    const auto a = ranges.allocate(100, 1), b = ranges.allocate(100, 1), c = ranges.allocate(100, 1);
    ASSERT_TRUE(a && b && c);
    ranges.free(*a, 100);
    ranges.free(*c, 100);
    EXPECT_EQ(ranges.holeCount(), 2u);
    EXPECT_EQ(ranges.allocate(150, 1), std::nullopt);
    ranges.free(*b, 100);
    EXPECT_EQ(ranges.holeCount(), 1u);
    EXPECT_TRUE(ranges.empty());
    EXPECT_EQ(ranges.allocate(300, 256), 0u);
}

TEST(RangeAllocator, TakesTheTightestHole) {
    RangeAllocator ranges(1000);
    const auto big = ranges.allocate(500, 1);
    ASSERT_TRUE(ranges.allocate(10, 1));
    const auto small = ranges.allocate(50, 1);
    ASSERT_TRUE(ranges.allocate(440, 1));
    ranges.free(*big, 500);
    ranges.free(*small, 50);
    EXPECT_EQ(ranges.allocate(40, 1), *small);
}

TEST(RangeAllocator, RandomUseNeverOverlapsAndComesBackWhole) {
    std::mt19937 random(20);
    RangeAllocator ranges(1 << 16);
    std::map<uint64_t, uint64_t> held; // offset -> size
    size_t allocations = 0;
    for (int step = 0; step < 20000; ++step) {
        if (random() % 3 && held.size() < 400) {
            const uint64_t size = 1 + random() % 300;
            const uint64_t alignment = uint64_t{1} << random() % 9;
            const auto offset = ranges.allocate(size, alignment);
            if (!offset) continue;
            ASSERT_EQ(*offset % alignment, 0u);
            ASSERT_LE(*offset + size, ranges.size());
            const auto next = held.lower_bound(*offset);
            ASSERT_TRUE(next == held.end() || *offset + size <= next->first);
            ASSERT_TRUE(next == held.begin() || std::prev(next)->first + std::prev(next)->second <= *offset);
            held.emplace(*offset, size);
            ++allocations;
        } else if (!held.empty()) {
            const auto victim = std::next(held.begin(), static_cast<long>(random() % held.size()));
            ranges.free(victim->first, victim->second);
            held.erase(victim);
        }
    }
    for (const auto& [offset, size] : held)
        ranges.free(offset, size);
    EXPECT_TRUE(ranges.empty());
    EXPECT_EQ(ranges.holeCount(), 1u);
    EXPECT_GT(allocations, 5000u);
}

} // namespace
} // namespace q3rt
