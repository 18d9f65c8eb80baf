#include <gtest/gtest.h>

#include <cmath>

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
    const TexturePart part = findTextureParts(makeTexture(6, 9, true)).withAlpha[0];
    // Texels 6 to 9 of 16, 3 to 4 of 8, and a texel to each side of the coarser level.
    EXPECT_FLOAT_EQ(part.least.x, 2.0f / 8);
    EXPECT_FLOAT_EQ(part.greatest.y, 6.0f / 8);
    const TexturePart all = findTextureParts(makeTexture(6, 9, true)).withColor[0];
    EXPECT_EQ(all.least, vec2(0.0f)) << "a texture without anything is left alone";
    EXPECT_EQ(all.greatest, vec2(1.0f));
}

TEST(EffectTrim, WhatTouchesASideOfARepeatedTextureComesInAtTheOther) {
    EXPECT_EQ(findTextureParts(makeTexture(0, 5, false)).withAlpha[0].greatest.x, 1.0f);
    EXPECT_LT(findTextureParts(makeTexture(0, 5, true)).withAlpha[0].greatest.x, 1.0f);
}

class EffectStage : public testing::Test {
  protected:
    EffectStage() {
        m_stage.blended = true;
        m_stage.depthWrite = false;
        m_stage.source = BlendFactor::SrcAlpha;
        m_stage.destination = BlendFactor::One;
    }
    void turn(float degrees, float scale) {
        const float c = scale * std::cos(glm::radians(degrees)), s = scale * std::sin(glm::radians(degrees));
        m_state.unit[0].modCount = 1;
        m_state.unit[0].mods[0].matrix = vec4(c, s, -s, c);
        m_state.unit[0].mods[0].translate = vec2(0.5f) - 0.5f * vec2(c - s, s + c); // about the centre
    }
    TexturePart shown(float texelsPerPixel = 1.0f, bool clamp = true) const {
        return findPartShown(m_stage, m_state, findTextureParts(makeTexture(6, 9, clamp)), texelsPerPixel);
    }
    Stage m_stage;
    StageState m_state{};
};

TEST_F(EffectStage, HasAPartIfItsBlendKeepsWhatIsBehind) {
    EXPECT_FALSE(shown().whole());
    m_stage.destination = BlendFactor::OneMinusSrcAlpha;
    EXPECT_FALSE(shown().whole());
    m_stage.destination = BlendFactor::Zero;
    EXPECT_TRUE(shown().whole()) << "black where it is clear";
}

TEST_F(EffectStage, MayTurnAndStretchATextureThatEnds) {
    const TexturePart still = shown();
    turn(0, 2); // twice as many texels a pixel: the picture is half as large
    const TexturePart half = shown(0.5f);
    EXPECT_NEAR(half.least.x, 0.5f + 0.5f * (still.least.x - 0.5f), 1e-6f);
    EXPECT_NEAR(half.greatest.y, 0.5f + 0.5f * (still.greatest.y - 0.5f), 1e-6f);
    turn(45, 1);
    const TexturePart turned = shown(1.0f / 1.01f);
    EXPECT_LT(turned.least.x, still.least.x);
    EXPECT_GT(turned.least.x, 0.0f);
    EXPECT_TRUE(shown(1.0f / 1.01f, false).whole()) << "one that begins anew shows in the corners";
    turn(0, 0.25f);
    EXPECT_TRUE(shown().whole()) << "it is larger than the square";
    m_state.unit[0].mods[0].kind = kModTurb;
    EXPECT_TRUE(shown().whole());
}

TEST_F(EffectStage, TurnedShowsEveryPixelThatHasSomething) {
    const Texture texture = makeTexture(6, 9, true);
    for (const float degrees : {10.0f, 45.0f, 130.0f, 211.0f}) {
        turn(degrees, 1.3f);
        const TexturePart part = shown(0.5f);
        const TexModState& mod = m_state.unit[0].mods[0];
        constexpr int kSteps = 200;
        for (int i = 0; i < kSteps * kSteps; ++i) {
            const vec2 st = (vec2(i % kSteps, i / kSteps) + 0.5f) / float(kSteps);
            const vec2 at = vec2(st.x * mod.matrix.x + st.y * mod.matrix.z, st.x * mod.matrix.y + st.y * mod.matrix.w) +
                            mod.translate;
            const vec2 texel = at * float(kSize);
            if (glm::any(glm::lessThan(texel, vec2(5.5f))) || glm::any(glm::greaterThan(texel, vec2(10.5f)))) continue;
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(st, part.least)) &&
                        glm::all(glm::lessThanEqual(st, part.greatest)));
        }
    }
}

TEST_F(EffectStage, IsLeftAloneWhereMipLevelsAreReadThatNobodyLookedAt) {
    EXPECT_FALSE(shown(15.0f).whole());
    EXPECT_TRUE(shown(17.0f).whole());
}

class EffectSquareTest : public testing::Test {
  protected:
    EffectSquareTest() {
        m_view.sizePx = vec2(640, 480);
        m_view.clipFromModel = mat4(0.0f); // w = z
        m_view.clipFromModel[0][0] = m_view.clipFromModel[1][1] = m_view.clipFromModel[2][2] = 1;
        m_view.clipFromModel[2][3] = 1;
        for (size_t i = 0; i < 4; ++i) {
            m_square[i].st = vec2(i & 1, i >> 1);
            m_square[i].position = vec3(m_square[i].st * 4.0f - 2.0f, 10.0f);
        }
    }
    bool usable() const { return EffectSquare(m_square, m_view).usable(); }
    TriangleView m_view;
    std::array<Vertex, 4> m_square{};
};

TEST_F(EffectSquareTest, IsTheSamePlaneWithTheSameTextureOnIt) {
    std::array<Vertex, 4> part;
    EffectSquare(m_square, m_view).write({vec2(0.25f, 0.5f), vec2(0.75f, 1.0f)}, part);
    EXPECT_EQ(part[0].st, vec2(0.25f, 0.5f));
    EXPECT_EQ(part[3].st, vec2(0.75f, 1.0f));
    for (const Vertex& vertex : part)
        EXPECT_EQ(vertex.position, vec3(vertex.st * 4.0f - 2.0f, 10.0f));
}

TEST_F(EffectSquareTest, CountsTexels) {
    // 4 qu at a distance of 10 are 0.4 of half the view: 128 by 96 pixels.
    EXPECT_FLOAT_EQ(EffectSquare(m_square, m_view).texelsPerPixel(vec2(96)), 1.0f);
}

TEST_F(EffectSquareTest, IsLeftAloneIfItIsNoneOrTilted) {
    EXPECT_TRUE(usable());
    m_square[0].position.z = m_square[1].position.z = 14.0f;
    EXPECT_FALSE(usable()) << "tilted";
    m_square[0].position.z = m_square[1].position.z = 10.0f;
    m_square[1].color = 7;
    EXPECT_FALSE(usable()) << "colours differ";
    m_square[1].color = 0;
    m_square[3].position.x += 1.0f;
    EXPECT_FALSE(usable()) << "no parallelogram";
    m_square[3].position.x -= 1.0f;
    m_square[2].st.y = 2.0f;
    EXPECT_FALSE(usable()) << "the texture is not there once";
}

} // namespace
} // namespace q3rt
