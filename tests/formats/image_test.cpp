// Images: the quirks that content was authored against, round trips of the writers, and refusal of damaged files.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <thread>

#include "base/error.hpp"
#include "formats/image.hpp"
#include "support/tiny_files.hpp"

namespace q3rt {
namespace {

using Pixels = std::vector<uint8_t>;

bool refused(const std::vector<std::byte>& file, const char* name) {
    try {
        decodeImage(file, name);
    } catch (const ContentError& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with(std::string(name) + ": ")) << error.what();
        return true;
    }
    return false;
}

TEST(Tga, RowsAreBottomUpWhateverTheDescriptorSays) {
    const Pixels payload{1, 2, 3, 4, 5, 6}; // two rows of one pixel, blue green red
    const Pixels expected{6, 5, 4, 255, 3, 2, 1, 255};
    EXPECT_EQ(decodeImage(test::makeTga(2, 1, 2, 24, payload), "a.tga").rgba, expected);
    EXPECT_EQ(decodeImage(test::makeTga(2, 1, 2, 24, payload, 0x20), "a.TGA").rgba, expected);
}

TEST(Tga, ThirtyTwoBitsKeepAlphaAndGreyIsSpread) {
    EXPECT_EQ(decodeImage(test::makeTga(2, 1, 1, 32, {1, 2, 3, 4}), "a.tga").rgba, (Pixels{3, 2, 1, 4}));
    EXPECT_EQ(decodeImage(test::makeTga(3, 2, 1, 8, {9, 8}), "a.tga").rgba, (Pixels{9, 9, 9, 255, 8, 8, 8, 255}));
}

TEST(Tga, PacketsMayCrossRowsAndMayRunOver) {
    // Two pixels wide, two high: a run of three, then a raw packet of four of which one is needed.
    const Pixels payload{0x82, 1, 2, 3, 0x03, 4, 5, 6, 7, 8, 9};
    const Pixels expected{3, 2, 1, 255, 6, 5, 4, 255, 3, 2, 1, 255, 3, 2, 1, 255};
    EXPECT_EQ(decodeImage(test::makeTga(10, 2, 2, 24, payload), "a.tga").rgba, expected);
}

TEST(Tga, WhatTheEngineRefuses) {
    EXPECT_TRUE(refused(test::makeTga(1, 1, 1, 8, {0}), "a.tga"));
    EXPECT_TRUE(refused(test::makeTga(9, 1, 1, 8, {0}), "a.tga"));
    EXPECT_TRUE(refused(test::makeTga(2, 1, 1, 16, {0, 0}), "a.tga"));
    EXPECT_TRUE(refused(test::makeTga(2, 0, 1, 24, {0, 0, 0}), "a.tga"));
    EXPECT_TRUE(refused(test::makeTga(2, 1, 2, 24, {0, 0, 0, 0, 0}), "a.tga"));
    EXPECT_TRUE(refused(test::makeTga(10, 2, 1, 24, {0x80, 1, 2, 3}), "a.tga"));
    EXPECT_TRUE(refused(test::makeTga(2, 65535, 65535, 32, {0, 0}), "a.tga"));
    EXPECT_TRUE(refused(test::makeTga(10, 20000, 20000, 24, {0xFF, 0, 0, 0}), "a.tga"));
    EXPECT_TRUE(refused({}, "a.tga"));
}

TEST(Pcx, PaletteAndRuns) {
    const Image image = decodeImage(test::makePcx(2, 2, {5, 0xC3, 200}), "a.pcx");
    EXPECT_EQ(image.rgba, (Pixels{5, 250, 7, 255, 200, 55, 7, 255, 200, 55, 7, 255, 200, 55, 7, 255}));
}

TEST(Pcx, WhatTheEngineRefuses) {
    std::vector<std::byte> planes = test::makePcx(1, 1, {5});
    planes[65] = std::byte{3};
    EXPECT_TRUE(refused(planes, "a.pcx"));
    EXPECT_TRUE(refused(test::makePcx(2, 2, {5}), "a.pcx"));
    EXPECT_TRUE(refused(test::makePcx(1024, 1, Pixels(1024, 5)), "a.pcx"));
    EXPECT_TRUE(refused(test::makePcx(1023, 1023, {5}), "a.pcx"));
    EXPECT_TRUE(refused({}, "a.pcx"));
}

TEST(Bmp, DepthsPaddingAndBottomUpRows) {
    const Image image = decodeImage(test::makeBmp(1, 2, 24, {1, 2, 3, 0, 4, 5, 6, 0}), "a.bmp");
    EXPECT_EQ(image.rgba, (Pixels{6, 5, 4, 255, 3, 2, 1, 255}));
    // A negative height means top-down, and is taken bottom-up all the same.
    EXPECT_EQ(decodeImage(test::makeBmp(1, -2, 24, {1, 2, 3, 0, 4, 5, 6, 0}), "a.bmp").rgba, image.rgba);
    EXPECT_EQ(decodeImage(test::makeBmp(1, 1, 32, {1, 2, 3, 4}), "a.bmp").rgba, (Pixels{3, 2, 1, 4}));
    Pixels paletted(1024 + 4, 0);
    paletted[4 * 9] = 1;
    paletted[4 * 9 + 2] = 3;
    paletted[1024] = 9;
    EXPECT_EQ(decodeImage(test::makeBmp(1, 1, 8, paletted), "a.bmp").rgba, (Pixels{3, 0, 1, 255}));
}

TEST(Bmp, WhatTheEngineRefuses) {
    EXPECT_TRUE(refused(test::makeBmp(1, 1, 16, {1, 2, 0, 0}), "a.bmp"));
    EXPECT_TRUE(refused(test::makeBmp(2, 2, 24, {1, 2, 3, 0}), "a.bmp"));
    EXPECT_TRUE(refused(test::makeBmp(0x7FFFFFFF, 0x7FFFFFFF, 32, {1, 2, 3, 0}), "a.bmp"));
    EXPECT_TRUE(refused(test::makeBmp(-1, 1, 24, {1, 2, 3, 0}), "a.bmp"));
    EXPECT_TRUE(refused(test::makeBmp(1, std::numeric_limits<int>::min(), 24, {1, 2, 3, 0}), "a.bmp"));
    EXPECT_TRUE(refused({}, "a.bmp"));
}

/// A picture in which no two neighbours are alike.
Pixels makePattern(int width, int height, int channels) {
    Pixels pixels;
    for (int i = 0; i < width * height * channels; ++i)
        pixels.push_back(static_cast<uint8_t>(i * 37 + i / 7));
    return pixels;
}

TEST(Png, RoundTripIsExact) {
    const Pixels rgba = makePattern(5, 3, 4);
    const Image image = decodeImage(encodePng(5, 3, 4, rgba), "a.png");
    EXPECT_EQ(image.width, 5);
    EXPECT_EQ(image.height, 3);
    EXPECT_EQ(image.rgba, rgba);
    const Pixels rgb = makePattern(4, 2, 3);
    const Image opaque = decodeImage(encodePng(4, 2, 3, rgb), "a.png");
    for (size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(opaque.rgba[i * 4 + 1], rgb[i * 3 + 1]);
        EXPECT_EQ(opaque.rgba[i * 4 + 3], 255);
    }
}

TEST(Png, TruncationAndHugeClaimsAreRefused) {
    const std::vector<std::byte> whole = encodePng(5, 3, 4, makePattern(5, 3, 4));
    for (size_t length = 0; length + 12 < whole.size(); ++length)
        EXPECT_TRUE(refused({whole.begin(), whole.begin() + static_cast<long>(length)}, "a.png")) << length;
    std::vector<std::byte> huge = whole;
    for (const size_t offset : {17u, 21u})
        huge[offset] = std::byte{0x7F};
    EXPECT_TRUE(refused(huge, "a.png"));
}

// In a thread of its own, where the library has had nothing to say yet.
TEST(Png, DamageWithoutAReasonIsRefusedToo) {
    std::vector<std::byte> file = encodePng(5, 3, 4, makePattern(5, 3, 4));
    constexpr size_t kFirstBlock = 43;   // behind the signature, the header's chunk, and two bytes of zlib's
    file[kFirstBlock] = std::byte{0x07}; // the last block, of the fourth of three kinds
    std::thread([&] { EXPECT_TRUE(refused(file, "a.png")); }).join();
}

TEST(Tga, ScreenshotRoundTripIsExact) {
    const Pixels rgb = makePattern(5, 3, 3);
    const std::vector<std::byte> file = encodeTga24(5, 3, rgb);
    EXPECT_EQ(file.size(), 18u + 45u);
    const Image image = decodeImage(file, "a.tga");
    for (size_t i = 0; i < 15; ++i) {
        for (size_t channel = 0; channel < 3; ++channel)
            EXPECT_EQ(image.rgba[i * 4 + channel], rgb[i * 3 + channel]);
    }
}

TEST(Jpeg, RoundTripIsCloseAndOpaque) {
    // A slow ramp, which the format keeps; at quality 90 every chroma sample is stored.
    Pixels rgb;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x)
            rgb.insert(rgb.end(), {uint8_t(x * 8), uint8_t(y * 8), uint8_t(128)});
    }
    const Image image = decodeImage(encodeJpeg(16, 16, rgb, 90), "a.jpg");
    ASSERT_EQ(image.rgba.size(), 16u * 16u * 4u);
    int largest = 0;
    for (size_t i = 0; i < 256; ++i) {
        for (size_t channel = 0; channel < 3; ++channel)
            largest = std::max(largest, std::abs(image.rgba[i * 4 + channel] - rgb[i * 3 + channel]));
        EXPECT_EQ(image.rgba[i * 4 + 3], 255);
    }
    // Coefficients of a ramp are quantised in steps of at most 20 at quality 90: half a step, and a rounding.
    EXPECT_LE(largest, 11);
}

TEST(Jpeg, DamageIsRefusedOrShown) {
    const std::vector<std::byte> whole = encodeJpeg(16, 16, makePattern(16, 16, 3), 90);
    for (size_t length = 0; length < 200; ++length)
        EXPECT_TRUE(refused({whole.begin(), whole.begin() + static_cast<long>(length)}, "a.jpg")) << length;
    // A file that lacks only its end shows what it has.
    EXPECT_FALSE(refused({whole.begin(), whole.end() - 40}, "a.jpg"));
}

TEST(Pfm, RoundTripIsExactAndTopRowFirst) {
    const std::vector<float> rgb{1, 2, 3, -4, 5e-30f, 6e30f, 7, 8, 9, 10, 11, 12};
    const std::vector<std::byte> file = encodePfm(1, 4, rgb);
    const FloatImage image = decodePfm(file, "a.pfm");
    EXPECT_EQ(image.width, 1);
    EXPECT_EQ(image.height, 4);
    EXPECT_EQ(image.rgb, rgb);
    float firstStored = 0;
    std::memcpy(&firstStored, file.data() + file.size() - 48, sizeof(float));
    EXPECT_EQ(firstStored, 10.0f); // the bottom row
}

TEST(Pfm, BigEndianIsReadAndDamageRefused) {
    const auto decode = [](const std::string& text) {
        const auto* first = reinterpret_cast<const std::byte*>(text.data());
        return decodePfm({first, text.size()}, "a.pfm");
    };
    const std::string one("\x3f\x80\0\0", 4);
    EXPECT_EQ(decode("PF\n1 1\n1.0\n" + one + one + one).rgb, (std::vector<float>{1, 1, 1}));
    for (const char* text : {"", "Pf\n1 1\n-1\n123456789012", "PF\n1 1\n-1\n12345678901", "PF\n0 1\n-1\n",
                             "PF\n99999999 99999999\n-1\n123", "PF\nx 1\n-1\n", "PF\n1 1\n0\n123456789012", "PF\n1"})
        EXPECT_THROW(decode(text), ContentError) << text;
}

TEST(Image, AnUnknownExtensionIsRefused) {
    EXPECT_TRUE(refused({}, "a.dds"));
    EXPECT_TRUE(refused({}, "dir.tga/a"));
    EXPECT_TRUE(refused({}, ""));
}

TEST(Image, WritersRefusePixelsThatDontFit) {
    EXPECT_THROW(encodePng(2, 2, 3, Pixels(11)), UsageError);
    EXPECT_THROW(encodePng(2, 2, 2, Pixels(8)), UsageError);
    EXPECT_THROW(encodeTga24(2, 2, Pixels(11)), UsageError);
    EXPECT_THROW(encodeJpeg(2, 2, Pixels(11), 90), UsageError);
    EXPECT_THROW(encodePfm(2, 2, std::vector<float>(11)), UsageError);
}

} // namespace
} // namespace q3rt
