// Device memory: blocks grow, are shared, and go back to the driver; per-frame buffers.

#include <algorithm>
#include <cstring>

#include "gpu/frame_ring.hpp"
#include "gpu/gpu_image.hpp"
#include "gpu/growing_buffer.hpp"
#include "gpu/readback.hpp"
#include "gpu/uploader.hpp"
#include "gpu_test.hpp"

namespace q3rt {
namespace {

class MemoryTest : public GpuTest {};

TEST_F(MemoryTest, SmallBuffersShareBlocksAndGiveThemBack) {
    std::vector<Buffer> buffers;
    for (uint32_t i = 0; i < 300; ++i)
        buffers.emplace_back(device(), BufferInfo{.size = 1000 + 16 * i});
    const MemoryUse full = device().memory().measureUse();
    EXPECT_EQ(full.allocationCount, 300u);
    EXPECT_EQ(full.blockCount, 1u);
    EXPECT_GE(full.reservedBytes, full.usedBytes);
    buffers.clear();
    EXPECT_EQ(device().memory().measureUse().blockCount, 0u);
}

TEST_F(MemoryTest, LargeResourcesGetTheirOwnBlockAndBlocksGrow) {
    const Buffer huge(device(), {.size = VkDeviceSize{40} << 20});
    EXPECT_EQ(device().memory().measureUse().blockCount, 1u);
    std::vector<Buffer> buffers;
    for (int i = 0; i < 40; ++i)
        buffers.emplace_back(device(), BufferInfo{.size = VkDeviceSize{1} << 20});
    // 40 MiB in blocks of 80 MiB (twice the largest so far).
    EXPECT_EQ(device().memory().measureUse().blockCount, 2u);
    GpuImage image(device(), {.extent = {64, 64}});
    EXPECT_EQ(device().memory().measureUse().blockCount, 3u) << "images never share a block with buffers";
}

TEST_F(MemoryTest, MappedMemoryIsWhereItSays) {
    for (const MemoryDomain domain : {MemoryDomain::Upload, MemoryDomain::Readback}) {
        const Buffer first(device(), {.size = 256, .domain = domain});
        const Buffer second(device(), {.size = 256, .domain = domain});
        std::memset(first.mapped(), 1, 256);
        std::memset(second.mapped(), 2, 256);
        for (size_t i = 0; i < 256; ++i) {
            ASSERT_EQ(first.mapped()[i], std::byte{1});
            ASSERT_EQ(second.mapped()[i], std::byte{2});
        }
    }
    const Buffer local(device(), {.size = 256});
    EXPECT_EQ(local.mapped(), nullptr);
}

TEST_F(MemoryTest, LoadingMuchDoesNotStageItAllAtOnce) {
    constexpr size_t kBytes = size_t{24} << 20;
    const std::vector<std::byte> bytes(kBytes, std::byte{9});
    std::vector<Buffer> targets;
    Uploader uploader(device());
    VkDeviceSize mostStaged = 0;
    for (int i = 0; i < 6; ++i) {
        targets.emplace_back(device(), BufferInfo{.size = kBytes});
        uploader.upload(targets.back(), std::span<const std::byte>(bytes));
        mostStaged = std::max(mostStaged, device().memory().measureUse().usedBytes - targets.size() * kBytes);
    }
    uploader.flush();
    EXPECT_LE(mostStaged, VkDeviceSize{72} << 20);
    EXPECT_EQ(uploader.uploadedBytes(), 6 * kBytes);
    EXPECT_EQ(readBuffer(device(), targets[0])[kBytes - 1], std::byte{9});
    EXPECT_EQ(readBuffer(device(), targets[5])[0], std::byte{9});
}

TEST_F(MemoryTest, GrowingBufferKeepsSlicesOfItsFrame) {
    GrowingBuffer buffer(device(),
                         {.size = 256,
                          .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                          .domain = MemoryDomain::Upload});
    FrameRing ring(device());
    VkDeviceSize settled = 0;
    for (uint32_t frame = 0; frame < 12; ++frame) {
        ring.begin();
        buffer.beginFrame(ring.slot());
        std::vector<BufferSlice> slices;
        for (uint32_t i = 0; i < 100; ++i)
            slices.push_back(buffer.append(i, 64));
        for (uint32_t i = 0; i < 100; ++i) {
            uint32_t value = 0;
            std::memcpy(&value, slices[i].mapped, sizeof(value));
            ASSERT_EQ(value, i);
            ASSERT_EQ(slices[i].offset % 64, 0u);
            ASSERT_NE(slices[i].address, 0u);
        }
        ring.submit();
        if (frame == 6) settled = device().memory().measureUse().usedBytes;
    }
    EXPECT_EQ(device().memory().measureUse().usedBytes, settled) << "a steady frame takes no more memory";
}

} // namespace
} // namespace q3rt
