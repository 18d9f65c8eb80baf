// Memory for a driver's recorded commands: what Vulkan asks of an allocator, and that the heap is left alone.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <malloc.h>
#include <vector>

#include "gpu/command_memory.hpp"

namespace q3rt {
namespace {

class CommandMemoryTest : public testing::Test {
  protected:
    void* allocate(size_t size, size_t alignment = 8) {
        const VkAllocationCallbacks& c = *m_memory.callbacks();
        return c.pfnAllocation(c.pUserData, size, alignment, VK_SYSTEM_ALLOCATION_SCOPE_OBJECT);
    }
    void* reallocate(void* piece, size_t size) {
        const VkAllocationCallbacks& c = *m_memory.callbacks();
        return c.pfnReallocation(c.pUserData, piece, size, 8, VK_SYSTEM_ALLOCATION_SCOPE_OBJECT);
    }
    void free(void* piece) {
        const VkAllocationCallbacks& c = *m_memory.callbacks();
        c.pfnFree(c.pUserData, piece);
    }
    CommandMemory m_memory;
};

TEST_F(CommandMemoryTest, PiecesAreApartAndAligned) {
    std::vector<std::pair<unsigned char*, size_t>> pieces;
    for (size_t i = 0; i < 200; ++i) {
        const size_t size = 1 + i * 37, alignment = size_t{1} << (i % 8);
        auto* const piece = static_cast<unsigned char*>(allocate(size, alignment));
        ASSERT_NE(piece, nullptr);
        EXPECT_EQ(reinterpret_cast<uintptr_t>(piece) % alignment, 0u);
        std::memset(piece, static_cast<int>(i), size);
        pieces.emplace_back(piece, size);
    }
    for (size_t i = 0; i < pieces.size(); ++i) {
        EXPECT_EQ(pieces[i].first[0], i);
        EXPECT_EQ(pieces[i].first[pieces[i].second - 1], i);
        free(pieces[i].first);
    }
}

TEST_F(CommandMemoryTest, APieceGrowsAndShrinksWithWhatItHolds) {
    void* piece = reallocate(nullptr, 4);
    std::memcpy(piece, "abc", 4);
    piece = reallocate(piece, 5000);
    EXPECT_STREQ(static_cast<const char*>(piece), "abc");
    piece = reallocate(piece, 4);
    EXPECT_STREQ(static_cast<const char*>(piece), "abc");
    EXPECT_EQ(reallocate(piece, 0), nullptr);
    free(nullptr);
}

TEST_F(CommandMemoryTest, NoFrameKeepsMemoryOfTheLast) {
    const auto heapBytes = [] {
        const struct mallinfo2 info = mallinfo2();
        return info.uordblks + info.hblkhd;
    };
    for (const size_t size : {size_t{5} << 10, size_t{64} << 10, size_t{1} << 20}) {
        free(allocate(size));
        const size_t before = heapBytes();
        for (int frame = 0; frame < 1000; ++frame)
            free(allocate(size));
        EXPECT_LE(heapBytes(), before + size) << size;
    }
}

TEST_F(CommandMemoryTest, NoBytesHaveAPlace) {
    void* const piece = allocate(0);
    EXPECT_NE(piece, nullptr) << "lavapipe takes none for lack of memory";
    free(piece);
}

TEST_F(CommandMemoryTest, WhatIsGivenBackIsTakenAgain) {
    void* const first = allocate(120);
    free(first);
    EXPECT_EQ(allocate(120), first);
    free(first);
}

} // namespace
} // namespace q3rt
