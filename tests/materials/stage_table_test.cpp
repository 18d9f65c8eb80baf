// Stages at a time: colours as bytes, animation, scrolling for weeks, entity values; the table evaluates each once.
#include "scene/stage_table.hpp"

#include "library_fixture.hpp"

namespace q3rt {
namespace {

class StageAt : public test::LibraryFixture {
  protected:
    StageState at(double time, int stage = 0, float identityLight = 1) {
        StageInputs inputs;
        inputs.shaderTimeSeconds = time;
        return evaluateStage(compile(-1), compile(-1).stages[static_cast<size_t>(stage)], inputs, identityLight);
    }
};

int byteOf(float value) { return static_cast<int>(std::lround(value * 255)); }

TEST_F(StageAt, WaveColoursAreTheOriginalsBytes) {
    define("{ map a\n rgbGen wave sin 0.5 0.5 0 1\n alphaGen wave inversesawtooth 0 1 0 1\n }");
    const double times[4] = {1, 1.1, 1.25, 1.6};
    const int sine[4] = {127, 202, 254, 52}, alpha[4] = {255, 229, 191, 102};
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(byteOf(at(times[i]).color.r), sine[i]);
        EXPECT_EQ(byteOf(at(times[i]).color.a), alpha[i]);
    }
    EXPECT_EQ(byteOf(at(1.25, 0, 0.5f).color.g), 127) << "identity light scales rgb";
    EXPECT_EQ(byteOf(at(1.25, 0, 0.5f).color.a), 191) << "but not alpha";
}

TEST_F(StageAt, WavesOutsideTheRangeAreClamped) {
    define("{ map a\n rgbGen wave square 0 5 0 1\n alphaGen wave square 0.5 3 0 1\n }");
    EXPECT_EQ(at(0.1).color, vec4(1));
    EXPECT_EQ(at(0.6).color, vec4(0));
}

TEST_F(StageAt, IdentityLightAndVertexAlpha) {
    define("{ map a }\n{ map a\n rgbGen vertex\n alphaGen identity\n blendFunc add\n }\n"
           "{ map a\n rgbGen exactVertex\n blendFunc add\n }\n{ map a\n rgbGen lightingDiffuse\n blendFunc add\n }");
    EXPECT_EQ(byteOf(at(0, 0, 0.5f).color.r), 127);
    EXPECT_EQ(byteOf(at(0, 0, 0.5f).color.a), 255);
    EXPECT_EQ(at(0, 1, 1).alphaGen, kAlphaVertex) << "kept in a window, even after alphaGen identity";
    EXPECT_EQ(at(0, 1, 0.5f).alphaGen, kAlphaConstant);
    EXPECT_EQ(at(0, 1, 0.5f).color, vec4(0.5f, 0.5f, 0.5f, 1));
    EXPECT_EQ(at(0, 2, 0.5f).color, vec4(1));
    EXPECT_EQ(at(0, 2).rgbGen, kColorVertex);
    EXPECT_EQ(at(0, 3).rgbGen, kColorConstant) << "outside entities nothing is lit";
    EXPECT_EQ(at(0, 3).color, vec4(0));
}

TEST_F(StageAt, EntityValues) {
    define("{ map a\n rgbGen entity\n alphaGen oneMinusEntity\n }\n{ map a\n rgbGen oneMinusEntity\n alphaGen entity\n "
           "blendFunc add\n tcMod entityTranslate\n }\n{ map a\n rgbGen lightingDiffuse\n blendFunc add\n }");
    StageInputs inputs;
    inputs.shaderTimeSeconds = 10;
    inputs.entityColor = U8vec4(255, 128, 0, 64);
    inputs.entityTexCoord = vec2(0.125f, -0.33f);
    const Material& material = compile(-1);
    EXPECT_EQ(evaluateStage(material, material.stages[0], inputs, 1).color, vec4(0, 0, 0, 1)) << "no entity: 0";
    inputs.hasEntity = true;
    const vec4 entity = evaluateStage(material, material.stages[0], inputs, 1).color;
    EXPECT_EQ(U8vec4(glm::round(entity * 255.0f)), U8vec4(255, 128, 0, 191));
    const StageState other = evaluateStage(material, material.stages[1], inputs, 1);
    EXPECT_EQ(U8vec4(glm::round(other.color * 255.0f)), U8vec4(0, 127, 255, 64));
    EXPECT_NEAR(other.unit[0].mods[0].translate.x, 0.25, 1e-6);
    EXPECT_NEAR(other.unit[0].mods[0].translate.y, 0.7, 1e-6);
    EXPECT_EQ(evaluateStage(material, material.stages[2], inputs, 1).rgbGen, kColorLightingDiffuse);
}

TEST_F(StageAt, AnimationFrameRule) {
    define("{ animMap 10 a b c\n }");
    compile(-1);
    const TextureId frames[3] = {textureOf("a"), textureOf("b"), textureOf("c")};
    int checked = 0;
    for (double time = 0; time < 20; time += 0.0373) {
        const auto frame = (static_cast<int64_t>(time * 10 * 1024) >> 10) % 3;
        EXPECT_EQ(at(time).unit[0].texture, frames[frame]) << time;
        ++checked;
    }
    EXPECT_EQ(checked, 537);
    EXPECT_EQ(at(-5).unit[0].texture, frames[0]) << "negative times show the first frame";
    EXPECT_EQ(at(1e9 + 0.15).unit[0].texture, frames[static_cast<int64_t>((1e9 + 0.15) * 10) % 3]);
}

TEST_F(StageAt, ScrollsStayExactForWeeks) {
    define("{ map a\n tcMod scroll 0.1 -3\n }");
    for (const double time : {0.0, 1.7, 3600.3, 21 * 86400.0 + 0.4}) {
        const TexModState& mod = at(time).unit[0].mods[0];
        const double x = time * 0.1f, y = time * -3.0f;
        EXPECT_NEAR(mod.translate.x, x - std::floor(x), 1e-7);
        EXPECT_NEAR(mod.translate.y, y - std::floor(y), 1e-7);
        EXPECT_TRUE(mod.translate.x >= 0 && mod.translate.x < 1);
    }
}

TEST_F(StageAt, ModsApplyInTextOrder) {
    define(
        "{ map a\n tcMod scale 4 4\n tcMod scroll 0.1 0\n }\n{ map a\n blendFunc add\n tcMod scroll 0.1 0\n"
        "tcMod scale 4 4\n }\n{ map a\n blendFunc add\n tcMod scale 2 2\n tcMod bogus\n tcMod scale 9 9\n }\n"
        "{ map a\n blendFunc add\n tcMod scroll 1 0\n tcMod turb 0 1 0 1\n tcMod scale 3 3\n tcMod scroll 0.5 0\n }");
    EXPECT_NEAR(at(1, 0).unit[0].mods[0].translate.x, 0.1, 1e-6);
    EXPECT_NEAR(at(1, 1).unit[0].mods[0].translate.x, 0.4, 1e-6);
    EXPECT_EQ(at(1, 0).unit[0].modCount, 1u) << "folded";
    EXPECT_EQ(at(1, 2).unit[0].mods[0].matrix, vec4(2, 0, 0, 2)) << "an unknown mod stops the later ones";
    const TextureUnitState turbed = at(1.5, 3).unit[0];
    ASSERT_EQ(turbed.modCount, 3u) << "folded up to the turb and after it";
    EXPECT_EQ(turbed.mods[1].kind, kModTurb);
    EXPECT_NEAR(turbed.mods[1].matrix.y, 0.5, 1e-6);
    EXPECT_NEAR(turbed.mods[2].translate.x, 0.75, 1e-6);
}

TEST_F(StageAt, RotationTurnsClockwise) {
    define("{ map a\n tcMod rotate 90\n }");
    // After one second by 90 degrees: s' = t, t' = 1 - s about the centre, to the accuracy of the 1023-step table.
    const TexModState& mod = at(1).unit[0].mods[0];
    const vec2 top(0.5f, 0);
    const vec2 turned =
        vec2(top.x * mod.matrix.x + top.y * mod.matrix.z, top.x * mod.matrix.y + top.y * mod.matrix.w) + mod.translate;
    EXPECT_NEAR(turned.x, 0, 0.01);
    EXPECT_NEAR(turned.y, 0.5, 0.01);
}

TEST_F(StageAt, StretchAtZeroStaysFinite) {
    define("{ map a\n tcMod stretch sin 0 0 0 1\n }");
    EXPECT_TRUE(std::isfinite(at(1).unit[0].mods[0].matrix.x) && std::isfinite(at(1).unit[0].mods[0].translate.x));
}

TEST_F(StageAt, ClampTimeAndTimeOffset) {
    define("clampTime 2\n{ map a\n rgbGen wave sawtooth 0 1 0 0.1\n }");
    EXPECT_EQ(byteOf(at(1).color.r), 25);
    EXPECT_EQ(byteOf(at(9).color.r), byteOf(at(2).color.r));
    Material shifted = compile(-1);
    shifted.timeOffsetSeconds = 7.5;
    StageInputs inputs;
    inputs.shaderTimeSeconds = 8.5;
    EXPECT_EQ(byteOf(evaluateStage(shifted, shifted.stages[0], inputs, 1).color.r), 25);
}

class Table : public test::LibraryFixture {};

TEST_F(Table, EvaluatesEachUseOnce) {
    files.addText("scripts/t.shader", "still\n{\n{ clampmap a }\n}\nmoving\n{\n{ map b\n tcMod scroll 1 1\n }\n"
                                      "{ map c\n blendFunc add\n }\n}\ntinted\n{\n{ map d\n rgbGen entity\n }\n}\n");
    const MaterialId still = library().find("still", -1), moving = library().find("moving", -1);
    const MaterialId tinted = library().find("tinted", -1);
    StageTable table(library(), *textures, 1);
    StageInputs early, late, red;
    late.shaderTimeSeconds = 0.25;
    red.hasEntity = true;
    red.entityColor = U8vec4(255, 0, 0, 255);
    table.beginFrame();
    const StageRange first = table.evaluate(still, early);
    EXPECT_EQ(table.evaluate(still, late).first, first.first);
    EXPECT_EQ(table.evaluate(still, red).first, first.first) << "what is not read makes no difference";
    EXPECT_NE(table.evaluate(moving, early).first, table.evaluate(moving, late).first);
    EXPECT_EQ(table.evaluate(moving, late).count, 2u);
    EXPECT_EQ(table.evaluate(moving, red).first, table.evaluate(moving, early).first);
    EXPECT_NE(table.evaluate(tinted, red).first, table.evaluate(tinted, early).first);
    EXPECT_EQ(table.states().size(), 1u + 2 * 2 + 2);
    EXPECT_EQ(table.states()[first.first].unit[0].clamped, 1u);
    EXPECT_EQ(table.states()[table.evaluate(moving, late).first].unit[0].clamped, 0u);
}

TEST_F(Table, KeepsWhatNothingChanges) {
    files.addText("scripts/t.shader", "moving\n{\n{ map b\n tcMod scroll 1 1\n }\n}\nstill\n{\n{ clampmap a }\n}\n"
                                      "pair\n{\n{ map c }\n{ map d\n blendFunc add\n }\n}\n");
    const MaterialId still = library().find("still", -1), moving = library().find("moving", -1);
    const MaterialId pair = library().find("pair", -1);
    StageTable table(library(), *textures, 1);
    const auto textureOf = [&](MaterialId material) {
        return table.states()[table.evaluate(material, {}).first].unit[0].texture;
    };
    table.beginFrame();
    const uint32_t of[3] = {textureOf(moving), textureOf(still), textureOf(pair)};
    EXPECT_EQ(table.lastingCount(), 0u);
    table.beginFrame();
    EXPECT_EQ(table.lastingCount(), 3u) << "two of the pair, one that stands still";
    EXPECT_EQ(table.states().size(), 3u) << "what moves is forgotten";
    EXPECT_EQ(table.evaluate(still, {}).first, 0u);
    EXPECT_EQ(table.evaluate(pair, {}).first, 1u);
    EXPECT_EQ(table.evaluate(moving, {}).first, 3u);
    EXPECT_EQ(textureOf(moving), of[0]);
    EXPECT_EQ(textureOf(still), of[1]);
    EXPECT_EQ(textureOf(pair), of[2]);
    table.beginFrame();
    EXPECT_EQ(table.lastingCount(), 3u);
    EXPECT_EQ(table.evaluate(pair, {}).first, 1u) << "at the same place in every frame";
}

TEST_F(Table, FollowsRemappingAndItsOffset) {
    files.addText("scripts/t.shader", "old\n{\n{ map a }\n}\nnew\n{\n{ map b\n rgbGen wave sawtooth 0 1 0 1\n }\n}\n");
    const MaterialId old = library().find("old", 0);
    library().remap("old", "new", "0.75");
    StageTable table(library(), *textures, 1);
    StageInputs inputs;
    inputs.shaderTimeSeconds = 1.25;
    const StageRange range = table.evaluate(old, inputs);
    EXPECT_EQ(byteOf(table.states()[range.first].color.r), 127);
}

} // namespace
} // namespace q3rt
