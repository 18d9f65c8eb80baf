// Every keyword with a meaning of its own, and what each kind of bad text does (spec of materials, 1.3, 2.1 to 2.4).
#include "library_fixture.hpp"

namespace q3rt {
namespace {

class Keyword : public test::LibraryFixture {};

TEST_F(Keyword, BadTextGivesTheDefaultMaterial) {
    const char* bodies[] = {
        "{ map a } cull none foo",
        "sort 3 4 { map a }",
        "nomipmaps 1 { map a }",
        "{ map missing }",
        "{ clampmap $whiteimage }",
        "{ animMap 1 a missing }",
        "unknown { map a }",
        "{ map a unknown }",
        "{ map a blendFunc GL_ONE }",
        "fogparms 1 1 1 100 { map a }",
        "{ map a\n tcMod scroll 1 1\n tcMod scroll 1 1\n tcMod scroll 1 1\n tcMod scroll 1 1\n tcMod scroll 1 1\n }",
        "surfaceparm trans",
        "skyparms - 512"};
    std::string text;
    int count = 0;
    for (const char* body : bodies)
        text += "t" + std::to_string(count++) + "\n{\n" + body + "\n}\n";
    files.addText("scripts/t.shader", text);
    for (int i = 0; i < count; ++i) {
        const std::string name = "t" + std::to_string(i);
        const MaterialId id = library().find(name, 0);
        EXPECT_TRUE(library().get(id).isDefault) << bodies[i];
        EXPECT_EQ(library().registerHandle(name, -4), 0) << bodies[i];
        EXPECT_EQ(library().find(name, -1), id) << "remembered whatever the lightmap: " << bodies[i];
    }
    EXPECT_EQ(count, 13);
}

TEST_F(Keyword, FailedDefinitionKeepsItsStages) {
    define("{ map a }\n{ map missing }\n{ map b }");
    const Material& material = compile();
    EXPECT_TRUE(material.isDefault);
    ASSERT_EQ(material.stages.size(), 1u);
    EXPECT_EQ(material.stages[0].unit[0].frames[0], textureOf("a"));
}

TEST_F(Keyword, UnknownWordsWarnAndKeepTheDefault) {
    define("cull sideways\n{ map a\n rgbGen fog\n alphaGen fog\n tcGen fog\n depthFunc fog\n alphaFunc fog\n"
           "blendFunc GL_FOG GL_FOG\n }");
    const Material& material = compile();
    ASSERT_FALSE(material.isDefault);
    const Stage& stage = material.stages[0];
    EXPECT_EQ(material.cull, CullMode::Front);
    EXPECT_EQ(stage.rgbGen, RgbGen::IdentityLighting);
    EXPECT_EQ(stage.alphaGen, AlphaGen::Identity);
    EXPECT_EQ(stage.depthFunc, DepthFunc::LessEqual);
    EXPECT_EQ(stage.alphaTest, AlphaTest::None);
    EXPECT_EQ(stage.source, BlendFactor::One);
    EXPECT_EQ(stage.destination, BlendFactor::One) << "an unknown factor is GL_ONE";
}

TEST_F(Keyword, GeneralKeywords) {
    define("surfaceparm nomarks\nsurfaceparm water\nsurfaceparm nonsense\ncull disable\npolygonOffset\nentityMergable\n"
           "clampTime 3.5\nlight 1\ntesssize 64 64\nqer_trans 0.5 junk\nq3map_onlyfast whatever\nsort additive\n"
           "fogparms ( 0.25 0.5 1 ) 300 rest of line\n{ map a }");
    const Material& m = compile();
    ASSERT_FALSE(m.isDefault);
    EXPECT_EQ(m.surfaceFlags, surfaceParm::kNoMarks);
    EXPECT_EQ(m.contentFlags, surfaceParm::kContentsWater);
    EXPECT_EQ(m.cull, CullMode::None);
    EXPECT_TRUE(m.polygonOffset && m.entityMergable && m.explicitScript);
    EXPECT_EQ(m.clampTimeSeconds, 3.5f);
    EXPECT_EQ(m.sort, 10);
    EXPECT_EQ(m.fog.color, vec3(0.25f, 0.5f, 1));
    EXPECT_EQ(m.fog.depthForOpaque, 300);
}

TEST_F(Keyword, Deforms) {
    define("deformVertexes wave 100 sin 3 2 0.1 4\ndeformVertexes move 1 2 3 sawtooth 0 5 0 0.2\n"
           "deformVertexes bulge 3 10 1\n{ map a }");
    const auto& deforms = compile().deforms;
    ASSERT_EQ(deforms.size(), 3u);
    EXPECT_EQ(deforms[0].kind, DeformKind::Wave);
    EXPECT_FLOAT_EQ(deforms[0].spread, 0.01f);
    EXPECT_EQ(deforms[0].wave.amplitude, 2);
    EXPECT_EQ(deforms[1].kind, DeformKind::Move);
    EXPECT_EQ(deforms[1].move, vec3(1, 2, 3));
    EXPECT_EQ(deforms[1].wave.function, WaveFunction::Sawtooth);
    EXPECT_EQ(deforms[1].wave.frequency, 0.2f);
    EXPECT_EQ(deforms[2].bulgeHeight, 10);
}

TEST_F(Keyword, OtherDeforms) {
    define("deformVertexes wave 0 sin 0 1 0 1\ndeformVertexes normal 0.5 2\ndeformVertexes text3\n"
           "deformVertexes autosprite\n{ map a }");
    const auto& deforms = compile().deforms;
    ASSERT_EQ(deforms.size(), 3u) << "a fourth only warns";
    EXPECT_EQ(deforms[0].spread, 100);
    EXPECT_EQ(deforms[1].wave.amplitude, 0.5f) << "the first number is the amplitude";
    EXPECT_EQ(deforms[1].wave.frequency, 2);
    EXPECT_EQ(deforms[2].kind, DeformKind::Text);
    EXPECT_EQ(deforms[2].text, 3);
}

TEST_F(Keyword, ConstantColoursWrapLikeBytes) {
    define("{ map a\n rgbGen const ( 2.0 1.5 -0.5 )\n alphaGen const 0.5\n }\n"
           "{ map b\n blendFunc add\n rgbGen const ( 0.5 0.25 1)\n }");
    const Material& material = compile();
    ASSERT_EQ(material.stages.size(), 2u);
    EXPECT_EQ(material.stages[0].constantColor, U8vec4(254, 126, 129, 127));
    EXPECT_EQ(material.stages[1].constantColor, U8vec4(127, 63, 255, 255)) << "a missing last bracket costs nothing";
}

TEST_F(Keyword, BlendAndDepthWrite) {
    define("{ map a\n blendFunc blend\n }\n{ map b\n depthWrite\n blendFunc GL_DST_COLOR GL_ONE_MINUS_DST_ALPHA\n }\n"
           "{ map c\n blendFunc GL_ONE GL_ZERO\n }\n{ map d\n blendFunc filter\n depthWrite\n depthFunc equal\n }");
    const auto& s = compile().stages;
    ASSERT_EQ(s.size(), 4u);
    EXPECT_TRUE(s[0].blended && !s[0].depthWrite);
    EXPECT_EQ(s[0].rgbGen, RgbGen::IdentityLighting) << "GL_SRC_ALPHA keeps the lit default";
    EXPECT_TRUE(s[1].blended && s[1].depthWrite);
    EXPECT_EQ(s[1].source, BlendFactor::DstColor);
    EXPECT_EQ(s[1].destination, BlendFactor::OneMinusDstAlpha);
    EXPECT_EQ(s[1].rgbGen, RgbGen::Identity);
    EXPECT_TRUE(!s[2].blended && s[2].depthWrite);
    EXPECT_TRUE(s[3].depthWrite);
    EXPECT_EQ(s[3].depthFunc, DepthFunc::Equal);
}

TEST_F(Keyword, GeneratorsAndTheirAlpha) {
    define("{ map a\n rgbGen vertex\n }\n{ map a\n blendFunc add\n rgbGen vertex\n alphaGen identity\n }\n"
           "{ map a\n blendFunc add\n alphaGen const 1\n rgbGen vertex\n }\n"
           "{ map a\n blendFunc add\n rgbGen wave noise 1 2 3 4\n alphaGen portal 300\n }\n"
           "{ map a\n blendFunc add\n rgbGen lightingDiffuse\n alphaGen lightingSpecular\n }\n"
           "{ map a\n blendFunc add\n rgbGen wave bogus 1 2 3 4\n alphaGen portal\n }");
    const Material& m = compile();
    ASSERT_EQ(m.stages.size(), 6u);
    EXPECT_EQ(m.stages[0].alphaGen, AlphaGen::Vertex);
    EXPECT_EQ(m.stages[1].alphaGen, AlphaGen::Identity);
    EXPECT_EQ(m.stages[2].alphaGen, AlphaGen::Constant);
    EXPECT_EQ(m.stages[3].rgbWave.function, WaveFunction::Noise);
    EXPECT_EQ(m.stages[3].rgbWave.frequency, 4);
    EXPECT_EQ(m.portalRange, 256) << "the last one wins, 256 without a number";
    EXPECT_EQ(m.stages[4].alphaGen, AlphaGen::LightingSpecular);
    EXPECT_EQ(m.stages[4].bakedLight, BakedLight::LightGrid);
    EXPECT_EQ(m.stages[5].rgbWave.function, WaveFunction::Sin);
}

TEST_F(Keyword, TextureCoordinates) {
    define("{ map a\n tcGen vector ( 1 2 3 ) ( 4 5 6 )\n tcMod turb sin 0 0 0 0\n tcMod scale 2 3\n tcMod bogus\n"
           "tcMod scroll 1 1\n }\n{ map $lightmap\n blendFunc filter\n rgbGen identity\n }\n"
           "{ map a\n tcGen environment\n blendFunc add\n tcMod stretch triangle 1 2 3 4\n"
           "tcMod transform 1 2 3 4 5 6\n tcMod rotate 30\n }");
    const Material& m = compile();
    ASSERT_FALSE(m.isDefault);
    ASSERT_EQ(m.stages.size(), 2u);
    const TextureUnit& first = m.stages[0].unit[0];
    EXPECT_EQ(first.texCoordGen, TexCoordGen::Vector);
    EXPECT_EQ(first.texCoordVectors[1], vec3(4, 5, 6));
    ASSERT_EQ(first.mods.size(), 4u);
    EXPECT_EQ(first.mods[0].wave.base, 0) << "'sin' reads as the number 0, the rest moves up";
    EXPECT_EQ(first.mods[2].kind, TexModKind::None);
    EXPECT_EQ(m.stages[0].unit[1].texCoordGen, TexCoordGen::Lightmap);
    const TextureUnit& last = m.stages[1].unit[0];
    EXPECT_EQ(last.texCoordGen, TexCoordGen::Environment);
    EXPECT_EQ(last.mods[0].wave.function, WaveFunction::Triangle);
    EXPECT_EQ(last.mods[1].value[5], 6);
    EXPECT_EQ(last.mods[2].value[0], 30);
}

TEST_F(Keyword, ImageFlagsDependOnWhatStoodEarlier) {
    define("{ map a }\nnomipmaps\n{ map b\n blendFunc add\n }\n{ clampmap c\n blendFunc add\n }");
    compile();
    EXPECT_TRUE(textures->get(textureOf("a")).flags.mipmap);
    EXPECT_FALSE(textures->get(textureOf("b")).flags.mipmap);
    EXPECT_FALSE(textures->get(textureOf("b")).flags.picmip);
    EXPECT_TRUE(textures->get(textureOf("c")).flags.clamp);
}

TEST_F(Keyword, ClampmapFirstLoadWins) {
    define("{ clampmap a }\n{ map a\n blendFunc add\n }");
    const Material& m = compile();
    EXPECT_EQ(m.stages[0].unit[0].frames, m.stages.back().unit[0].frames);
    EXPECT_TRUE(textures->get(m.stages.back().unit[0].frames[0]).flags.clamp);
}

TEST_F(Keyword, VideoAndAnimation) {
    define("{ videoMap v.roq }\n{ animMap 10 a b c d e f a b c\n blendFunc add\n }");
    const Material& m = compile();
    ASSERT_EQ(m.stages.size(), 2u);
    EXPECT_EQ(m.stages[0].unit[0].videoSlot, 5);
    EXPECT_EQ(m.stages[0].unit[0].frames[0], builtinTexture::kScratch0 + 5);
    EXPECT_EQ(m.stages[1].unit[0].frames.size(), 8u) << "only 8 frames count";
}

TEST_F(Keyword, SkyBoxAndCloudHeight) {
    for (const char* side : {"rt", "lf", "bk", "up", "dn"})
        files.addTga(std::string("env/x_") + side + ".tga");
    files.addText("scripts/sky.shader",
                  "one\n{\nskyparms env/x 0 -\n}\ntwo\n{\nskyparms env/none 128 -\n{ map a }\n}\n");
    const Material& one = library().get(library().find("one", -1));
    EXPECT_TRUE(one.isSky && one.sky.hasBox && !one.isDefault);
    EXPECT_EQ(one.sort, 2);
    EXPECT_EQ(one.sky.cloudHeight, 512);
    EXPECT_EQ(one.sky.box[3], builtinTexture::kDefault) << "no _ft image";
    EXPECT_EQ(one.sky.box[2], textureOf("env/x_bk.tga"));
    const Material& two = library().get(library().find("two", -1));
    EXPECT_TRUE(two.isSky && !two.sky.hasBox);
    EXPECT_EQ(library().lastCloudHeight, 128) << "the last one parsed holds for all";
}

TEST_F(Keyword, LightDirectives) {
    define("q3map_sunExt 0.5 0.25 0 200 90 30 2.5 16\nq3map_surfacelight 1500\nq3map_lightimage lights/x.tga\n"
           "q3map_lightRGB 1 2 4\nqer_editorimage ed.tga\nq3map_skylight 70 3\nq3map_backsplash 0 10\n"
           "surfaceparm alphashadow\n{ map a }");
    const LightDirectives& light = compile().light;
    EXPECT_EQ(light.surfaceLight, 1500);
    EXPECT_EQ(light.lightImage, "lights/x.tga");
    EXPECT_EQ(light.editorImage, "ed.tga");
    EXPECT_EQ(light.color, vec3(0.25f, 0.5f, 1));
    EXPECT_EQ(light.skyLight, 70);
    EXPECT_EQ(light.skyLightIterations, 3);
    EXPECT_EQ(light.backsplashPercent, 0);
    EXPECT_EQ(light.backsplashDistance, 10);
    EXPECT_TRUE(light.alphaShadow);
    ASSERT_EQ(light.suns.size(), 1u);
    EXPECT_EQ(light.suns[0].color, vec3(1, 0.5f, 0));
    EXPECT_EQ(light.suns[0].devianceDegrees, 2.5f);
    EXPECT_NEAR(library().sunDirection.y, std::cos(30 * 3.14159265358979 / 180), 1e-6);
    EXPECT_NEAR(library().sunDirection.z, 0.5, 1e-6);
    EXPECT_NEAR(glm::length(library().sunLight), 200, 1e-3);
}

} // namespace
} // namespace q3rt
