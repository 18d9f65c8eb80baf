// Textures: search, cache, upload pipeline, built-ins (spec of materials, 1.7 and 4.2 to 4.6).
#include "scene/texture.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "memory_files.hpp"
#include "scene/texture_upload.hpp"

namespace q3rt {
namespace {

using test::MemoryFiles;

U8vec4 texel(const MipLevel& level, int x, int y) {
    const size_t i = static_cast<size_t>(y * level.width + x) * 4;
    return {level.rgba[i], level.rgba[i + 1], level.rgba[i + 2], level.rgba[i + 3]};
}

/// Every channel of every texel is different from its neighbours'.
U8vec4 pattern(int x, int y) {
    return {static_cast<uint8_t>(x * 37 + y * 11), static_cast<uint8_t>(x * 5 + y * 71),
            static_cast<uint8_t>(x * y * 13 + 7), static_cast<uint8_t>(255 - x * 3 - y * 19)};
}

TEST(Texture, FindsFilesInTheEnginesOrder) {
    MemoryFiles files;
    files.addTga("a.tga", U8vec4(10, 0, 0, 255));
    files.addTga("b.c.tga", U8vec4(20, 0, 0, 255));
    TextureLibrary textures(files, {});
    for (const char* name : {"a.tga", "a", "a.jpg", "a.bmp", "A.TGA"}) {
        const bool found = textures.load(name, {}).has_value();
        EXPECT_EQ(found, std::string(name) != "A.TGA") << name; // this source is case-sensitive, the engine's is not
    }
    EXPECT_TRUE(textures.load("b.c", {})) << "an unknown extension belongs to the name";
    EXPECT_FALSE(textures.load("missing", {}));
    EXPECT_FALSE(textures.load("", {}));
    EXPECT_FALSE(textures.load(std::string(64, 'x'), {}));
    EXPECT_NE(textures.load("a", {}), textures.load("a.tga", {})) << "the cache key is the exact string";
    EXPECT_FALSE(textures.load("*nothing", {}));
    EXPECT_EQ(textures.load("*white", {}), builtinTexture::kWhite);
    EXPECT_EQ(textures.load("*default", {}), builtinTexture::kDefault);
    EXPECT_EQ(textures.load("*scratch", {}), builtinTexture::kScratch0);
}

TEST(Texture, DamagedFileIsMissingAndTheNextExtensionIsTried) {
    MemoryFiles files;
    files.addText("broken.tga", "not an image");
    TextureLibrary textures(files, {});
    EXPECT_FALSE(textures.load("broken.tga", {}));
}

TEST(Texture, FirstLoadDecidesTheFlags) {
    MemoryFiles files;
    files.addTga("a.tga");
    TextureLibrary textures(files, {});
    const auto first = textures.load("a.tga", {false, false, true});
    const auto second = textures.load("a.tga", {true, true, false});
    ASSERT_TRUE(first);
    EXPECT_EQ(first, second);
    EXPECT_TRUE(textures.get(*first).flags.clamp);
    EXPECT_EQ(textures.get(*first).levels.size(), 1u);
}

TEST(Texture, Resamples12x12To8x8Exactly) {
    MemoryFiles files;
    files.addTga("a.tga", 12, 12, pattern);
    TextureLibrary textures(files, {});
    const MipLevel& level = textures.get(*textures.load("a.tga", {})).levels[0];
    ASSERT_EQ(level.width, 8);
    ASSERT_EQ(level.height, 8);
    const int step = 65536 * 12 / 8; // exact: 98304
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) {
            const int a = (step / 4 + j * step) >> 16, b = (3 * (step / 4) + j * step) >> 16;
            const int upper = static_cast<int>((i + 0.25) * 12 / 8), lower = static_cast<int>((i + 0.75) * 12 / 8);
            for (int k = 0; k < 4; ++k) {
                const int sum =
                    pattern(a, upper)[k] + pattern(b, upper)[k] + pattern(a, lower)[k] + pattern(b, lower)[k];
                EXPECT_EQ(texel(level, j, i)[k], sum >> 2);
            }
        }
}

TEST(Texture, RoundsUpWhenAsked) {
    MemoryFiles files;
    files.addTga("a.tga", 12, 3, pattern);
    TextureSettings settings;
    settings.roundImagesDown = false;
    TextureLibrary textures(files, settings);
    const MipLevel& level = textures.get(*textures.load("a.tga", {})).levels[0];
    EXPECT_EQ(level.width, 16);
    EXPECT_EQ(level.height, 4);
}

TEST(Texture, MipsAreTruncatedMeansOfTheLevelAbove) {
    MemoryFiles files;
    files.addTga("a.tga", 8, 2, pattern);
    TextureLibrary textures(files, {});
    const auto& levels = textures.get(*textures.load("a.tga", {})).levels;
    ASSERT_EQ(levels.size(), 4u); // 8x2, 4x1, 2x1, 1x1
    for (int x = 0; x < 4; ++x)
        for (int k = 0; k < 4; ++k) {
            int sum = 0;
            for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}})
                sum += texel(levels[0], 2 * x + dx, dy)[k];
            EXPECT_EQ(texel(levels[1], x, 0)[k], sum >> 2);
        }
    for (int x = 0; x < 2; ++x)
        for (int k = 0; k < 4; ++k)
            EXPECT_EQ(texel(levels[2], x, 0)[k],
                      (texel(levels[1], 2 * x, 0)[k] + texel(levels[1], 2 * x + 1, 0)[k]) >> 1);
}

TEST(Texture, KernelMipsAndTintedMips) {
    MemoryFiles files;
    files.addTga("a.tga", 4, 4, pattern);
    TextureSettings settings;
    settings.simpleMipMaps = false;
    settings.colorMipLevels = true;
    TextureLibrary textures(files, settings);
    const auto& levels = textures.get(*textures.load("a.tga", {})).levels;
    const int weight[4] = {1, 2, 2, 1};
    int sum = 0;
    for (int dy = 0; dy < 4; ++dy)
        for (int dx = 0; dx < 4; ++dx)
            sum += weight[dx] * weight[dy] * pattern((dx - 1) & 3, (dy - 1) & 3).r;
    EXPECT_EQ(texel(levels[1], 0, 0).r, ((sum / 36) * 127 + 255 * 128) >> 9);
    EXPECT_EQ(texel(levels[0], 0, 0), pattern(0, 0));
}

TEST(Texture, PicmipAndLightScaleFollowTheFlags) {
    MemoryFiles files;
    for (const char* name : {"mip.tga", "raw.tga", "shrunk.tga"})
        files.addTga(name, 8, 8, [](int, int) { return U8vec4(128, 64, 32, 128); });
    TextureSettings settings;
    settings.picmip = 1;
    settings.gamma = 2;
    settings.intensity = 1.5f;
    TextureLibrary textures(files, settings);
    const Texture& mip = textures.get(*textures.load("mip.tga", {true, true, false}));
    const Texture& raw = textures.get(*textures.load("raw.tga", {false, false, true}));
    const Texture& shrunk = textures.get(*textures.load("shrunk.tga", {false, true, true}));
    const auto gamma = [](int i) { return static_cast<int>(255 * std::sqrt(i / 255.0) + 0.5); };
    EXPECT_EQ(mip.levels[0].width, 4);
    EXPECT_EQ(texel(mip.levels[0], 0, 0), U8vec4(gamma(192), gamma(96), gamma(48), 128));
    EXPECT_EQ(raw.levels[0].width, 8);
    EXPECT_EQ(texel(raw.levels[0], 0, 0), U8vec4(128, 64, 32, 128)) << "un-mipped and unshrunk: uploaded raw";
    EXPECT_EQ(texel(shrunk.levels[0], 0, 0), U8vec4(gamma(128), gamma(64), gamma(32), 128)) << "no intensity";
    EXPECT_TRUE(raw.hasAlpha);
}

TEST(Texture, GreyscaleUsesLuma) {
    MemoryFiles files;
    files.addTga("a.tga", U8vec4(200, 100, 50, 255));
    TextureSettings settings;
    settings.greyscale = 1;
    TextureLibrary textures(files, settings);
    const int luma = static_cast<int>(0.2126 * 200 + 0.7152 * 100 + 0.0722 * 50);
    EXPECT_EQ(texel(textures.get(*textures.load("a.tga", {})).levels[0], 0, 0), U8vec4(luma, luma, luma, 255));
}

TEST(Texture, BuiltInsFollowTheirFormulas) {
    MemoryFiles files;
    TextureSettings settings;
    settings.overbrightBits = 1;
    TextureLibrary textures(files, settings);
    const MipLevel& dlight = textures.get(builtinTexture::kDlight).levels[0];
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            int value = static_cast<int>(4000 / ((7.5 - x) * (7.5 - x) + (7.5 - y) * (7.5 - y)));
            value = value > 255 ? 255 : value < 75 ? 0 : value;
            EXPECT_EQ(texel(dlight, x, y), U8vec4(value, value, value, 255));
        }
    EXPECT_EQ(textures.get(builtinTexture::kDlight).levels.size(), 1u);

    const MipLevel& fog = textures.get(builtinTexture::kFog).levels[0];
    ASSERT_EQ(fog.width, 256);
    ASSERT_EQ(fog.height, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 256; ++x) {
            // In integers: s' = 8 x / 256, times (y - 1/2) / 30 below the last row; 255 s' truncated.
            const int steps = y == 0    ? 0
                              : y == 31 ? std::min(255, 255 * x / 32)
                                        : std::min(255, 255 * x * (2 * y - 1) / (32 * 60));
            EXPECT_EQ(texel(fog, x, y), U8vec4(255, 255, 255, static_cast<int>(255 * std::sqrt(steps / 255.0))))
                << x << ' ' << y;
        }

    const Texture& missing = textures.get(builtinTexture::kDefault);
    EXPECT_EQ(texel(missing.levels[0], 0, 7), U8vec4(255));
    EXPECT_EQ(texel(missing.levels[0], 1, 7), U8vec4(64, 64, 64, 32)) << "mip-mapped: the gamma table shifts it";
    EXPECT_EQ(missing.levels.size(), 5u);
    EXPECT_EQ(texel(textures.get(builtinTexture::kIdentityLight).levels[0], 3, 3), U8vec4(127, 127, 127, 255));
    EXPECT_EQ(texel(textures.get(builtinTexture::kScratch0).levels[0], 3, 3), U8vec4(127, 127, 127, 255));
}

TEST(Texture, BakedLightShiftKeepsTheHue) {
    int checked = 0;
    for (int shift = 0; shift <= 2; ++shift)
        for (int r = 0; r < 256; r += 5)
            for (int g = 0; g < 256; g += 7)
                for (int b = 0; b < 256; b += 11) {
                    const int wide[3] = {r << shift, g << shift, b << shift};
                    const int largest = std::max({wide[0], wide[1], wide[2]});
                    const U8vec4 result = shiftBakedLight(U8vec4(r, g, b, 9), shift);
                    for (int k = 0; k < 3; ++k)
                        EXPECT_EQ(result[k], largest > 255 ? wide[k] * 255 / largest : wide[k]);
                    EXPECT_EQ(result.a, 9);
                    ++checked;
                }
    EXPECT_EQ(checked, 3 * 52 * 37 * 24);
}

TEST(Texture, LightmapPagesAreShiftedAndNamed) {
    MemoryFiles files;
    TextureLibrary textures(files, {});
    std::vector<uint8_t> page(128 * 128 * 3, 20);
    page[3] = 200;
    const TextureId id = textures.addLightmap(7, page.data());
    EXPECT_EQ(textures.load("*lightmap7", {}), id);
    EXPECT_EQ(texel(textures.get(id).levels[0], 0, 0), U8vec4(80, 80, 80, 255));
    EXPECT_EQ(texel(textures.get(id).levels[0], 1, 0), U8vec4(255, 80 * 255 / 800, 80 * 255 / 800, 255));
    EXPECT_TRUE(textures.get(id).flags.clamp);
    EXPECT_EQ(textures.get(id).levels.size(), 1u);
}

TEST(Texture, LightmapIntensityAsHue) {
    MemoryFiles files;
    TextureSettings settings;
    settings.lightmapIntensity = true;
    TextureLibrary textures(files, settings);
    std::vector<uint8_t> page(128 * 128 * 3, 0);
    std::fill_n(page.begin() + 3, 3, uint8_t{255}); // 1.078, cut at 1: the last sextant begins
    page[7] = 149;                                  // green alone: 0.400, two sextants in
    const MipLevel& level = textures.get(textures.addLightmap(0, page.data())).levels[0];
    EXPECT_EQ(texel(level, 0, 0), U8vec4(127, 0, 0, 255));
    EXPECT_EQ(texel(level, 1, 0), U8vec4(127, 0, 127, 255));
    EXPECT_EQ(texel(level, 2, 0), U8vec4(0, 127, 0, 255));
}

TEST(Texture, ScratchPixelsChangeTheVersionAndLoseTheirAlpha) {
    MemoryFiles files;
    TextureLibrary textures(files, {});
    const std::vector<uint8_t> pixels = {1, 2, 3, 4, 5, 6, 7, 8};
    const uint32_t before = textures.get(builtinTexture::kScratch0 + 3).version;
    textures.setScratch(3, 2, 1, pixels.data());
    const Texture& scratch = textures.get(builtinTexture::kScratch0 + 3);
    EXPECT_EQ(scratch.version, before + 1);
    EXPECT_EQ(texel(scratch.levels[0], 1, 0), U8vec4(5, 6, 7, 255));
    EXPECT_ANY_THROW(textures.setScratch(32, 2, 1, pixels.data()));
}

TEST(Texture, AverageColourIsOfTheRawFile) {
    MemoryFiles files;
    files.addTga("a.tga", 2, 1, [](int x, int) { return x ? U8vec4(255, 0, 51, 255) : U8vec4(0, 0, 51, 255); });
    TextureSettings settings;
    settings.gamma = 2;
    TextureLibrary textures(files, settings);
    const auto mean = textures.averageColorOf("a");
    ASSERT_TRUE(mean);
    EXPECT_NEAR(mean->r, 0.5, 1e-6);
    EXPECT_NEAR(mean->b, 0.2, 1e-6);
    EXPECT_FALSE(textures.averageColorOf("b"));
}

} // namespace
} // namespace q3rt
