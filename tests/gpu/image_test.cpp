// Images with mips, bindless textures, samplers, readback.

#include <cstring>

#include "gpu/bindless_textures.hpp"
#include "gpu/compute_pipeline.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/readback.hpp"
#include "gpu/sampler.hpp"
#include "gpu/uploader.hpp"
#include "gpu_test.hpp"
#include "spirv/shaders_sample_mips_comp.hpp"

namespace q3rt {
namespace {

/// width * height texels of one RGBA8 colour.
std::vector<uint32_t> fill(uint32_t width, uint32_t height, uint32_t rgba) {
    return std::vector<uint32_t>(size_t{width} * height, rgba);
}

class ImageTest : public GpuTest {
  protected:
    /// 8 x 4 texels, 4 mip levels; level m has red = base + m.
    GpuImage makeImage(Uploader& uploader, uint32_t base) {
        GpuImage image(device(), {.extent = {8, 4}, .mipCount = countMips({8, 4}), .name = "mips"});
        for (uint32_t mip = 0; mip < image.info().mipCount; ++mip)
            uploader.upload(image,
                            std::as_bytes(std::span<const uint32_t>(
                                fill(8 >> mip, std::max(4 >> mip, 1), 0xff000000 | (base + mip)))),
                            mip);
        uploader.flush();
        return image;
    }

    /// Red byte of the centre of each {texture index, mip}.
    std::vector<int> sampleReds(BindlessTextures& textures, const std::vector<uint32_t>& queries) {
        const uint32_t count = static_cast<uint32_t>(queries.size() / 2);
        const Buffer query(device(), {.size = queries.size() * sizeof(uint32_t)});
        const Buffer result(device(), {.size = count * 4 * sizeof(float)});
        Uploader uploader(device());
        uploader.upload(query, std::span<const uint32_t>(queries));
        uploader.flush();
        const DescriptorLayout layout(device(), {{0}, {1}});
        const ComputePipeline pipeline(device(), {.shader = {shaders::shaders_sample_mips_comp},
                                                  .interface = {{textures.layout(), layout.handle()}, 4}});
        DescriptorArena arena(device());
        const VkDescriptorSet set =
            arena.make(layout, {bindStorageBuffer(0, query.handle()), bindStorageBuffer(1, result.handle())});
        device().submitAndWait([&](VkCommandBuffer commands) {
            pipeline.bind(commands);
            pipeline.bindSets(commands, {textures.set(), set});
            pipeline.push(commands, count);
            pipeline.dispatch(commands, (count + 7) / 8);
        });
        const std::vector<std::byte> bytes = readBuffer(device(), result);
        std::vector<int> reds;
        for (uint32_t i = 0; i < count; ++i) {
            float red = 0;
            std::memcpy(&red, bytes.data() + size_t{i} * 16, sizeof(red));
            reds.push_back(static_cast<int>(red * 255.0f + 0.5f));
        }
        return reds;
    }
};

TEST_F(ImageTest, MipsAreSampledThroughBindlessIndices) {
    Uploader uploader(device());
    const GpuImage white = makeImage(uploader, 200);
    const GpuImage first = makeImage(uploader, 10);
    const GpuImage second = makeImage(uploader, 50);
    const VkSampler sampler = device().samplers().find({});
    BindlessTextures textures(device(), white.view(), sampler, 2);
    const uint32_t a = textures.add(first.view(), sampler);
    const uint32_t b = textures.add(second.view(), sampler);
    EXPECT_EQ(sampleReds(textures, {a, 0, a, 1, a, 2, a, 3, b, 0, b, 3}), (std::vector<int>{10, 11, 12, 13, 50, 53}));

    // Growth keeps what was there; indices stay.
    const uint32_t c = textures.add(white.view(), sampler);
    EXPECT_GE(textures.capacity(), 3u);
    EXPECT_EQ(sampleReds(textures, {a, 2, b, 1, c, 0}), (std::vector<int>{12, 51, 200}));

    textures.replace(b, first.view(), sampler);
    EXPECT_EQ(sampleReds(textures, {b, 1}), (std::vector<int>{11}));
    textures.remove(c);
    EXPECT_EQ(textures.add(second.view(), sampler), c);
    EXPECT_EQ(sampleReds(textures, {c, 3}), (std::vector<int>{53}));
}

TEST_F(ImageTest, EqualSamplersAreOne) {
    SamplerCache& samplers = device().samplers();
    const VkSampler repeat = samplers.find({});
    EXPECT_EQ(samplers.find({}), repeat);
    EXPECT_NE(samplers.find({.addressU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE}), repeat);
    EXPECT_EQ(samplers.size(), 2u);
}

TEST_F(ImageTest, RegionsKeepTheRest) {
    Uploader uploader(device());
    GpuImage image(device(), {.extent = {4, 4}});
    uploader.upload(image, std::as_bytes(std::span<const uint32_t>(fill(4, 4, 1))));
    uploader.uploadRegion(image, {1, 2}, {2, 1}, std::as_bytes(std::span<const uint32_t>(fill(2, 1, 7))));
    uploader.flush();
    const std::vector<std::byte> bytes = readImage(device(), image);
    ASSERT_EQ(bytes.size(), 64u);
    size_t sevens = 0;
    for (size_t i = 0; i < 16; ++i) {
        const bool inside = i == 9 || i == 10;
        EXPECT_EQ(bytes[i * 4], std::byte(inside ? 7 : 1)) << "texel " << i;
        sevens += inside;
    }
    EXPECT_EQ(sevens, 2u);
    EXPECT_EQ(image.state.layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

TEST_F(ImageTest, WrongSizesAreRefusedInWords) {
    Uploader uploader(device());
    GpuImage image(device(), {.extent = {4, 4}});
    EXPECT_THROW(uploader.upload(image, std::as_bytes(std::span<const uint32_t>(fill(4, 3, 1)))), UsageError);
    EXPECT_THROW(GpuImage(device(), {.extent = {0, 4}}), UsageError);
    EXPECT_THROW(GpuImage(device(), {.extent = {1u << 24, 4}}), UsageError);
}

} // namespace
} // namespace q3rt
