// Buffers, uploads, compute shaders, descriptors, specialisation and push constants.

#include <cstring>
#include <numeric>

#include "gpu/compute_pipeline.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/readback.hpp"
#include "gpu/uploader.hpp"
#include "gpu_test.hpp"
#include "spirv/add_times_three.hpp"
#include "spirv/shaders_add_comp.hpp"

namespace q3rt {
namespace {

std::vector<uint32_t> readWords(Device& device, const Buffer& buffer) {
    const std::vector<std::byte> bytes = readBuffer(device, buffer);
    std::vector<uint32_t> words(bytes.size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.data(), bytes.size());
    return words;
}

class ComputeTest : public GpuTest {
  protected:
    /// a + factor b + addend for a = 0, 1, 2 ... and b = 10, 11, 12 ...
    std::vector<uint32_t> runAdd(Spirv code, uint32_t addend, uint32_t count) {
        std::vector<uint32_t> a(count), b(count);
        std::iota(a.begin(), a.end(), 0u);
        std::iota(b.begin(), b.end(), 10u);
        const VkDeviceSize bytes = count * sizeof(uint32_t);
        const Buffer bufferA(device(), {.size = bytes, .name = "a"});
        const Buffer bufferB(device(), {.size = bytes, .name = "b"});
        const Buffer sum(device(), {.size = bytes, .name = "sum"});
        Uploader uploader(device(), 256); // far less than is uploaded: staging has to grow
        uploader.upload(bufferA, std::span<const uint32_t>(a));
        uploader.upload(bufferB, std::span<const uint32_t>(b));
        uploader.flush();

        const DescriptorLayout layout(device(), {{0}, {1}, {2}});
        const ComputePipeline pipeline(
            device(), {.name = "add", .shader = {code, {addend}}, .interface = {{layout.handle()}, sizeof(uint32_t)}});
        DescriptorArena arena(device());
        const VkDescriptorSet set =
            arena.make(layout, {bindStorageBuffer(0, bufferA.handle()), bindStorageBuffer(1, bufferB.handle()),
                                bindStorageBuffer(2, sum.handle())});
        device().submitAndWait([&](VkCommandBuffer commands) {
            pipeline.bind(commands);
            pipeline.bindSets(commands, {set});
            pipeline.push(commands, count);
            pipeline.warmUp(commands);
            pipeline.dispatch(commands, (count + 63) / 64);
        });
        return readWords(device(), sum);
    }
};

TEST_F(ComputeTest, AddsNumbers) {
    const std::vector<uint32_t> sum = runAdd(shaders::shaders_add_comp, 5, 1000);
    ASSERT_EQ(sum.size(), 1000u);
    for (uint32_t i = 0; i < sum.size(); ++i)
        ASSERT_EQ(sum[i], i + (10 + i) + 5) << "element " << i;
}

TEST_F(ComputeTest, VariantOfTheSameSourceHasItsOwnMacros) {
    const std::vector<uint32_t> sum = runAdd(shaders::add_times_three, 0, 100);
    ASSERT_EQ(sum.size(), 100u);
    for (uint32_t i = 0; i < sum.size(); ++i)
        ASSERT_EQ(sum[i], i + 3 * (10 + i)) << "element " << i;
}

TEST_F(ComputeTest, ArenaMakesMoreSetsThanOnePoolHolds) {
    const Buffer buffer(device(), {.size = 64});
    const DescriptorLayout layout(device(), {{0}, {1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}});
    DescriptorArena arena(device());
    const Buffer uniform(device(), {.size = 64, .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT});
    size_t made = 0;
    for (int round = 0; round < 2; ++round, arena.reset())
        for (int i = 0; i < 500; ++i)
            made += arena.make(layout, {bindStorageBuffer(0, buffer.handle()),
                                        bindUniformBuffer(1, uniform.handle())}) != VK_NULL_HANDLE;
    EXPECT_EQ(made, 1000u);
}

TEST_F(ComputeTest, UploadBeyondTheEndIsRefusedInWords) {
    const Buffer buffer(device(), {.size = 16});
    Uploader uploader(device());
    const uint32_t words[8]{};
    EXPECT_THROW(uploader.upload(buffer, std::span<const uint32_t>(words)), UsageError);
}

TEST_F(ComputeTest, TooLongPushConstantsAreRefused) {
    const DescriptorLayout layout(device(), {{0}, {1}, {2}});
    const ComputePipeline pipeline(
        device(), {.shader = {shaders::shaders_add_comp}, .interface = {{layout.handle()}, sizeof(uint32_t)}});
    struct {
        uint32_t words[2];
    } tooLong{};
    device().submitAndWait(
        [&](VkCommandBuffer commands) { EXPECT_THROW(pipeline.push(commands, tooLong), UsageError); });
}

} // namespace
} // namespace q3rt
