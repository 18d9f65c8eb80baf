// Models, skins and fonts.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "formats/font.hpp"
#include "formats/md3.hpp"
#include "formats/skin.hpp"
#include "support/tiny_files.hpp"

namespace q3rt {
namespace {

std::string errorOf(const std::vector<std::byte>& file) {
    try {
        parseMd3(file, "models/tiny.md3");
    } catch (const ContentError& error) {
        return error.what();
    }
    return "";
}

TEST(Md3, ReadsFramesTagsAndSurfaces) {
    const Md3 model = parseMd3(test::makeTinyMd3(), "t");
    ASSERT_EQ(model.frames.size(), 2u);
    EXPECT_EQ(model.frames[1].radius, 2.0f);
    EXPECT_EQ(model.tagCount, 1u);
    ASSERT_EQ(model.tags.size(), 2u);
    EXPECT_EQ(model.tags[1].name, "tag_torso");
    EXPECT_EQ(model.tags[1].orientation.origin, vec3(1, 2, 3));
    EXPECT_EQ(model.tags[1].orientation.axis[1], vec3(0, 1, 0));
    ASSERT_EQ(model.surfaces.size(), 1u);
    const Md3Surface& surface = model.surfaces[0];
    EXPECT_EQ(surface.name, "h_part");
    EXPECT_EQ(surface.shaders, std::vector<std::string>{"a.tga"});
    EXPECT_EQ(surface.indices, (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_EQ(surface.st[1], vec2(1, 0));
    EXPECT_EQ(surface.vertexCount, 3u);
    ASSERT_EQ(surface.vertices.size(), 6u);
    EXPECT_EQ(surface.vertices[4].position(), vec3(4, -1, 0.5f)); // vertex 1 of frame 1
}

TEST(Md3, SurfaceNamesLoseTheirCaseAndNumber) {
    const std::pair<const char*, const char*> cases[] = {
        {"H_Plain_1", "h_plain"}, {"Head", "head"}, {"a_b", "a"}, {"_1", "_1"}, {"x_12", "x_12"}, {"", ""}};
    for (const auto& [name, clean] : cases)
        EXPECT_EQ(parseMd3(test::makeTinyMd3(name), "t").surfaces[0].name, clean) << name;
}

TEST(Md3, NormalsFollowTheTableOf1023Steps) {
    const Md3 model = parseMd3(test::makeTinyMd3(), "t");
    const auto sine = [](int step) { return std::sin((step & 1023) * 2.0 * std::numbers::pi / 1023.0); };
    for (int vertex = 0; vertex < 6; ++vertex) {
        const int code = vertex * 37, latitude = 4 * (code >> 8), longitude = 4 * (code & 255);
        const vec3 n = model.surfaces[0].vertices[static_cast<size_t>(vertex)].normal();
        // Each factor is rounded to float once, the product once more: 3 roundings of 2^-24.
        const double bound = 3.0 / (1 << 24);
        EXPECT_NEAR(n.x, sine(latitude + 256) * sine(longitude), bound);
        EXPECT_NEAR(n.y, sine(latitude) * sine(longitude), bound);
        EXPECT_NEAR(n.z, sine(longitude + 256), bound);
    }
}

TEST(Md3, EveryTruncationIsRefused) {
    const std::vector<std::byte> whole = test::makeTinyMd3();
    for (size_t length = 0; length < whole.size(); ++length)
        EXPECT_TRUE(
            errorOf({whole.begin(), whole.begin() + static_cast<long>(length)}).starts_with("models/tiny.md3: "))
            << length;
}

TEST(Md3, DamageIsRefused) {
    constexpr size_t kSurface = 108 + 2 * 56 + 2 * 112;
    const std::pair<size_t, uint32_t> damages[] = {
        {0, 0},                          // identifier
        {4, 14},                         // version
        {76, 0},                         // no frames
        {76, 0x40000000},                // frames
        {80, 0xFFFFFFFF},                // tags
        {84, 2},                         // surfaces
        {92, 0xFFFFFFF0},                // frames' offset
        {100, 0x7FFFFFFF},               // surfaces' offset
        {108, 0x7FC00000},               // a frame's bound is not a number
        {108 + 2 * 56 + 64, 0x7F800000}, // a tag's origin is infinite
        {kSurface + 72, 3},              // frames of the surface
        {kSurface + 76, 0x10000000},     // shaders
        {kSurface + 80, 0xFFFFFFFF},     // vertices
        {kSurface + 84, 0x20000000},     // triangles
        {kSurface + 88, 0xFFFFFF00},     // triangles' offset
        {kSurface + 104, 0},             // no end: the next surface would be this one
        {kSurface + 104, 0x7FFFFFFF},    // end
        {kSurface + 108 + 68, 3},        // index
    };
    for (const auto& [offset, value] : damages) {
        std::vector<std::byte> file = test::makeTinyMd3();
        test::overwrite(file, offset, value);
        EXPECT_NE(errorOf(file), "") << "offset " << offset << " value " << value;
    }
}

TEST(Skin, PairsTagsAndCommas) {
    const auto skin =
        parseSkin("H_Head,models/players/a/head.tga\ntag_weapon,\r\n\"l legs\",\"c d\" // x\nu_torso , b\n");
    ASSERT_EQ(skin.size(), 4u);
    EXPECT_EQ(skin[0].surface, "h_head");
    EXPECT_EQ(skin[0].shader, "models/players/a/head.tga");
    EXPECT_EQ(skin[1].surface, "l legs");
    EXPECT_EQ(skin[1].shader, "c d");
    EXPECT_EQ(skin[2].surface, "u_torso");
    EXPECT_EQ(skin[2].shader, ","); // white space before the comma makes it a word
    EXPECT_EQ(skin[3].surface, "b");
    EXPECT_EQ(skin[3].shader, "");
}

TEST(Skin, TagWithoutCommaAndEmptyFile) {
    const auto skin = parseSkin("tag_head\nh_head,a\n/* x */ l_legs,b");
    ASSERT_EQ(skin.size(), 2u);
    EXPECT_EQ(skin[1].surface, "l_legs");
    EXPECT_TRUE(parseSkin("").empty());
    EXPECT_TRUE(parseSkin(" \n// nothing").empty());
}

TEST(Font, ReadsGlyphsAndScale) {
    const Font font = parseFont(test::makeFont(), "fonts/fontImage_16.dat");
    EXPECT_EQ(font.glyphs[65].height, 65);
    EXPECT_EQ(font.glyphs[65].imageHeight, 6);
    EXPECT_EQ(font.glyphs[65].t2, 0.4f);
    EXPECT_EQ(font.glyphs[255].shaderName, "g255");
    EXPECT_EQ(font.glyphScale, 1.5f);
}

TEST(Font, AnotherSizeIsRefused) {
    std::vector<std::byte> file = test::makeFont();
    file.pop_back();
    EXPECT_THROW(parseFont(file, "f"), ContentError);
    EXPECT_THROW(parseFont({}, "f"), ContentError);
}

} // namespace
} // namespace q3rt
