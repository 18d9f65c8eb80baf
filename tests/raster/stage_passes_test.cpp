// Which stages share a pass, and which change nothing: pure CPU.

#include <gtest/gtest.h>

#include "renderer_vk/stage_passes.hpp"

namespace q3rt {
namespace {

Stage opaque() { return {}; }

Stage blended(BlendFactor source, BlendFactor destination) {
    Stage stage;
    stage.blended = true;
    stage.source = source;
    stage.destination = destination;
    stage.depthWrite = false;
    return stage;
}

Stage detail() { return blended(BlendFactor::DstColor, BlendFactor::SrcColor); }

std::vector<uint32_t> passLengths(const std::vector<Stage>& stages, bool merge = true) {
    std::vector<uint32_t> lengths;
    uint32_t next = 0;
    for (const StagePass& pass : findStagePasses(stages, merge)) {
        EXPECT_EQ(pass.firstStage, next);
        next += pass.stageCount;
        lengths.push_back(pass.stageCount);
    }
    EXPECT_EQ(next, stages.size());
    return lengths;
}

using Lengths = std::vector<uint32_t>;

TEST(StagePasses, EqualDepthKeepsOutOfHolesOnlyWhereNoStageBeforeHasDrawn) {
    Stage holes = opaque(), equal = detail();
    holes.alphaTest = AlphaTest::GreaterEqual128;
    equal.depthFunc = DepthFunc::Equal;
    EXPECT_EQ(passLengths({holes, equal}), Lengths({2}));
    EXPECT_EQ(passLengths({opaque(), holes, equal}), Lengths({1, 1, 1})) << "the first has the same depth in the holes";
}

TEST(StagePasses, BlendedStagesJoinTheOpaqueOneBeforeThem) {
    EXPECT_EQ(passLengths({opaque(), detail(), detail()}), Lengths({3}));
    EXPECT_EQ(passLengths({opaque(), detail(), detail()}, false), Lengths({1, 1, 1}));
    EXPECT_EQ(passLengths({opaque(), detail(), detail(), detail(), detail()}), Lengths({4, 1}));
    EXPECT_EQ(passLengths({opaque(), detail(), opaque(), detail()}), Lengths({2, 2}));
    EXPECT_EQ(passLengths({detail(), detail()}), Lengths({1, 1})) << "what lies below is not known";
}

TEST(StagePasses, StagesThatCoverOtherPixelsStayApart) {
    Stage holes = opaque(), whereHolesAreNot = detail();
    holes.alphaTest = AlphaTest::GreaterEqual128;
    whereHolesAreNot.depthFunc = DepthFunc::Equal;
    EXPECT_EQ(passLengths({holes, detail()}), Lengths({1, 1})) << "the second also fills the holes";
    EXPECT_EQ(passLengths({holes, whereHolesAreNot}), Lengths({2}));
    Stage writes = detail(), everywhere = detail(), noDepth = opaque(), two = detail();
    writes.depthWrite = true;
    everywhere.depthFunc = DepthFunc::Always;
    noDepth.depthWrite = false;
    two.combine = Combine::Multiply;
    EXPECT_EQ(passLengths({opaque(), writes}), Lengths({1, 1}));
    EXPECT_EQ(passLengths({opaque(), everywhere}), Lengths({1, 1}));
    EXPECT_EQ(passLengths({noDepth, detail()}), Lengths({1, 1}));
    EXPECT_EQ(passLengths({opaque(), two}), Lengths({1, 1}));
}

TEST(StagePasses, AStageWithoutEffectIsKnown) {
    using enum BlendFactor;
    const auto state = [](vec4 color, uint rgbGen = kColorConstant, uint alphaGen = kAlphaConstant) {
        StageState result{};
        result.color = color;
        result.rgbGen = rgbGen;
        result.alphaGen = alphaGen;
        return result;
    };
    const StageState black = state(vec4(0, 0, 0, 1)), clear = state(vec4(1, 1, 1, 0));
    EXPECT_TRUE(changesNothing(blended(One, One), black));
    EXPECT_TRUE(changesNothing(blended(Zero, OneMinusSrcColor), black));
    EXPECT_TRUE(changesNothing(blended(SrcAlpha, OneMinusSrcAlpha), clear));
    EXPECT_FALSE(changesNothing(blended(SrcAlpha, OneMinusSrcAlpha), black));
    EXPECT_FALSE(changesNothing(blended(DstColor, Zero), black));
    EXPECT_FALSE(changesNothing(blended(One, OneMinusSrcAlpha), clear));
    EXPECT_FALSE(changesNothing(blended(One, One), state(vec4(0, 0, 0, 1), kColorLightingDiffuse)));
    EXPECT_FALSE(changesNothing(blended(SrcAlpha, One), state(vec4(1, 1, 1, 0), kColorConstant, kAlphaVertex)));
    EXPECT_FALSE(changesNothing(opaque(), black));
    Stage writes = blended(One, One), adds = blended(One, One);
    writes.depthWrite = true;
    adds.combine = Combine::Add; // the second texture has no colour
    EXPECT_FALSE(changesNothing(writes, black));
    EXPECT_FALSE(changesNothing(adds, black));
}

} // namespace
} // namespace q3rt
