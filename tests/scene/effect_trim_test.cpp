#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/effect_trim.hpp"

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
        m_state.blended = 1;
        m_state.sourceBlend = kBlendSrcAlpha;
        m_state.destinationBlend = kBlendOne;
    }
    void turn(float degrees, float scale) {
        const float c = scale * std::cos(glm::radians(degrees)), s = scale * std::sin(glm::radians(degrees));
        m_state.unit[0].modCount = 1;
        m_state.unit[0].mods[0].matrix = vec4(c, s, -s, c);
        m_state.unit[0].mods[0].translate = vec2(0.5f) - 0.5f * vec2(c - s, s + c); // about the centre
    }
    TexturePart shown(float texelsPerPixel = 1.0f, bool clamp = true) const {
        return findPartShown(m_state, findTextureParts(makeTexture(6, 9, clamp)), texelsPerPixel);
    }
    StageState m_state{};
};

TEST_F(EffectStage, HasAPartIfItsBlendKeepsWhatIsBehind) {
    EXPECT_FALSE(shown().whole());
    m_state.destinationBlend = kBlendOneMinusSrcAlpha;
    EXPECT_FALSE(shown().whole());
    m_state.destinationBlend = kBlendZero;
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

// Of a square of 4 qu that is 128 by 96 pixels.
class EffectCells : public EffectStage {
  protected:
    EffectCells() {
        mat4 clip(0.0f); // w = z
        clip[0][0] = clip[1][1] = clip[2][2] = clip[2][3] = 1;
        for (size_t i = 0; i < 4; ++i) {
            m_square[i].st = vec2(i & 1, i >> 1);
            m_square[i].position = vec3(m_square[i].st * 4.0f - 2.0f, 10.0f);
        }
        m_clip = clip;
    }
    SquareCells shown(int first, int last, bool clamp = true) const {
        return findCellsShown(m_state, findTextureParts(makeTexture(first, last, clamp)),
                              EffectSquare(m_square, m_clip, {640, 480}));
    }
    std::array<Vertex, 4> m_square{};
    mat4 m_clip;
};

TEST_F(EffectCells, AreThoseThatFiltersReach) {
    const SquareCells cells = shown(6, 9);
    for (int t = 0; t < kSize; ++t) // a cell a texel; half a texel beyond the four, and the rounding
        EXPECT_EQ(cells[static_cast<size_t>(t)], t >= 5 && t <= 10 ? 0x07e0 : 0) << t;
}

TEST_F(EffectCells, AreStripesBeyondAClampedSide) {
    turn(0, 2);
    const SquareCells cells = shown(0, 1);
    EXPECT_EQ(cells[0], 0x003f)
        << "its own texels begin at the fourth cell; half a texel is one cell, so is the stripe";
    EXPECT_EQ(cells[7], 0) << "what is clear at the side is clear beyond it";
    EXPECT_NE(shown(0, 1, false)[12], 0) << "begins anew";
}

TEST_F(EffectCells, AreAllIfTheTextureTurnsOrCoversOrIsReadTooCoarsely) {
    const auto all = [](const SquareCells& cells) {
        return std::ranges::all_of(cells, [](uint16_t row) { return row == 0xffff; });
    };
    EXPECT_FALSE(all(shown(6, 9)));
    turn(30, 1);
    EXPECT_TRUE(all(shown(6, 9)));
    turn(0, 400);
    EXPECT_TRUE(all(shown(6, 9)));
    turn(0, 1);
    m_state.destinationBlend = kBlendZero;
    EXPECT_TRUE(all(shown(6, 9)));
}

class EffectSquareTest : public testing::Test {
  protected:
    EffectSquareTest() {
        m_clip = mat4(0.0f); // w = z
        m_clip[0][0] = m_clip[1][1] = m_clip[2][2] = 1;
        m_clip[2][3] = 1;
        for (size_t i = 0; i < 4; ++i) {
            m_square[i].st = vec2(i & 1, i >> 1);
            m_square[i].position = vec3(m_square[i].st * 4.0f - 2.0f, 10.0f);
        }
    }
    bool usable() const { return EffectSquare(m_square, m_clip, {640, 480}).usable(); }
    mat4 m_clip;
    std::array<Vertex, 4> m_square{};
};

TEST_F(EffectSquareTest, IsTheSamePlaneWithTheSameTextureOnIt) {
    std::array<Vertex, 4> part;
    EffectSquare(m_square, m_clip, {640, 480}).write({vec2(0.25f, 0.5f), vec2(0.75f, 1.0f)}, part);
    EXPECT_EQ(part[0].st, vec2(0.25f, 0.5f));
    EXPECT_EQ(part[3].st, vec2(0.75f, 1.0f));
    for (const Vertex& vertex : part)
        EXPECT_EQ(vertex.position, vec3(vertex.st * 4.0f - 2.0f, 10.0f));
}

TEST_F(EffectSquareTest, CountsTexels) {
    // 4 qu at a distance of 10 are 0.4 of half the view: 128 by 96 pixels.
    EXPECT_FLOAT_EQ(EffectSquare(m_square, m_clip, {640, 480}).texelsPerPixel(vec2(96)), 1.0f);
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
