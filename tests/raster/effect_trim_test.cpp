#include <gtest/gtest.h>

#include "renderer_vk/effect_trim.hpp"

namespace q3rt {
namespace {

constexpr int kSize = 16;

/// Black and clear but for texels [first, last] of both axes; half size beside it.
Texture makeTexture(int first, int last, bool clamp) {
    Texture texture;
    texture.flags.clamp = clamp;
    for (const int size : {kSize, kSize / 2}) {
        MipLevel level{size, size, std::vector<uint8_t>(static_cast<size_t>(size) * size * 4, 0)};
        const int scale = kSize / size;
        for (int y = first / scale; y <= last / scale; ++y)
            for (int x = first / scale; x <= last / scale; ++x)
                level.rgba[static_cast<size_t>(y * size + x) * 4 + 3] = 255;
        texture.levels.push_back(level);
    }
    return texture;
}

TEST(EffectTrim, APartHoldsWhatFiltersReach) {
    const TexturePart part = findTextureParts(makeTexture(6, 9, true)).withAlpha;
    // Texels 6 to 9 of 16, 3 to 4 of 8, and a texel to each side of the coarser level.
    EXPECT_FLOAT_EQ(part.least.x, 2.0f / 8);
    EXPECT_FLOAT_EQ(part.greatest.y, 6.0f / 8);
    const TexturePart all = findTextureParts(makeTexture(6, 9, true)).withColor;
    EXPECT_EQ(all.least, vec2(0.0f)) << "a texture without anything is left alone";
    EXPECT_EQ(all.greatest, vec2(1.0f));
}

TEST(EffectTrim, WhatTouchesASideOfARepeatedTextureComesInAtTheOther) {
    EXPECT_EQ(findTextureParts(makeTexture(0, 5, false)).withAlpha.greatest.x, 1.0f);
    EXPECT_LT(findTextureParts(makeTexture(0, 5, true)).withAlpha.greatest.x, 1.0f);
}

TEST(EffectTrim, OnlyBlendsThatKeepWhatIsBehindHaveAPart) {
    const TextureParts parts = findTextureParts(makeTexture(6, 9, true));
    Stage stage;
    StageState state{};
    stage.blended = true;
    stage.depthWrite = false;
    stage.source = BlendFactor::SrcAlpha;
    stage.destination = BlendFactor::OneMinusSrcAlpha;
    EXPECT_GT(findPartShown(stage, state, parts).least.x, 0.0f);
    stage.destination = BlendFactor::Zero;
    EXPECT_EQ(findPartShown(stage, state, parts).least.x, 0.0f) << "black where it is clear";
    stage.destination = BlendFactor::One;
    state.unit[0].modCount = 1;
    EXPECT_EQ(findPartShown(stage, state, parts).least.x, 0.0f) << "the texture moves";
}

class EffectSquare : public testing::Test {
  protected:
    EffectSquare() {
        m_view.sizePx = vec2(640, 480);
        m_view.clipFromModel = mat4(0.0f); // w = z
        m_view.clipFromModel[0][0] = m_view.clipFromModel[1][1] = m_view.clipFromModel[2][2] = 1;
        m_view.clipFromModel[2][3] = 1;
        for (size_t i = 0; i < 4; ++i) {
            m_square[i].st = vec2(i & 1, i >> 1);
            m_square[i].position = vec3(m_square[i].st * 4.0f - 2.0f, 10.0f);
        }
    }
    std::array<Vertex, 4> trimmed(vec2 sizeTexels = vec2(16)) const {
        std::array<Vertex, 4> square = m_square;
        trimSquare(square, {vec2(0.25f, 0.5f), vec2(0.75f, 1.0f)}, sizeTexels, m_view);
        return square;
    }
    TriangleView m_view;
    std::array<Vertex, 4> m_square{};
};

TEST_F(EffectSquare, IsTheSamePlaneWithTheSameTextureOnIt) {
    const std::array<Vertex, 4> square = trimmed();
    EXPECT_EQ(square[0].st, vec2(0.25f, 0.5f));
    EXPECT_EQ(square[3].st, vec2(0.75f, 1.0f));
    for (const Vertex& vertex : square)
        EXPECT_EQ(vertex.position, vec3(vertex.st * 4.0f - 2.0f, 10.0f));
}

TEST_F(EffectSquare, IsLeftAloneWhereItsTextureIsMadeSmaller) {
    EXPECT_EQ(trimmed(vec2(1024))[0].st, vec2(0.0f));
    m_square[0].position.z = m_square[1].position.z = 14.0f;
    EXPECT_EQ(trimmed()[0].st, vec2(0.0f)) << "tilted";
}

TEST_F(EffectSquare, IsLeftAloneIfItIsNone) {
    m_square[1].color = 7;
    EXPECT_EQ(trimmed()[0].st, vec2(0.0f)) << "colours differ";
    m_square[1].color = 0;
    m_square[3].position.x += 1.0f;
    EXPECT_EQ(trimmed()[0].st, vec2(0.0f)) << "no parallelogram";
    m_square[3].position.x -= 1.0f;
    m_square[2].st.y = 2.0f;
    EXPECT_EQ(trimmed()[0].st, vec2(0.0f)) << "the texture is not there once";
}

} // namespace
} // namespace q3rt
