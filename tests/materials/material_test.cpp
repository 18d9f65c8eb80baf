// What follows from a definition as a whole: sort, collapse, contexts, remapping, order (spec of materials, 1.5, 1.6,
// 2.2, 2.8, 3.1, 3.3 and 3.7).
#include "library_fixture.hpp"

namespace q3rt {
namespace {

class MaterialOf : public test::LibraryFixture {};

TEST_F(MaterialOf, ImagelessStageCutsOffAllLaterOnes) {
    define("{ map a }\n{ blendFunc add\n rgbGen identity\n }\n{ map b\n blendFunc add\n }");
    const Material& material = compile();
    EXPECT_FALSE(material.isDefault);
    EXPECT_EQ(material.stages.size(), 1u);
}

TEST_F(MaterialOf, SortFollowsTheFirstStage) {
    const std::pair<const char*, float> cases[] = {{"{ map a }", 3},
                                                   {"{ map a\n blendFunc add\n }", 9},
                                                   {"{ map a\n blendFunc add\n depthWrite\n }", 5},
                                                   {"{ map a }\n{ map b\n blendFunc add\n }", 3},
                                                   {"polygonOffset\n{ map a\n blendFunc add\n }", 4},
                                                   {"polygonOffset\nsort 6.5\n{ map a }", 6.5f},
                                                   {"portal\n{ map a }", 1},
                                                   {"sort nearest\n{ map a }", 16},
                                                   {"sort underwater\nskyparms - 0 -\n{ map a }", 2},
                                                   {"surfaceparm fog\nfogparms ( 1 1 1 ) 10\nsort 5", 7},
                                                   {"{ blendFunc add\n }", 7}};
    std::string text;
    for (size_t i = 0; i < std::size(cases); ++i)
        text += "t" + std::to_string(i) + "\n{\n" + cases[i].first + "\n}\n";
    files.addText("scripts/t.shader", text);
    for (size_t i = 0; i < std::size(cases); ++i) {
        const Material& material = library().get(library().find("t" + std::to_string(i), -1));
        EXPECT_EQ(material.sort, cases[i].second) << cases[i].first;
        EXPECT_EQ(material.isPortal, material.sort == 1);
        EXPECT_FALSE(material.isDefault) << cases[i].first;
    }
}

TEST_F(MaterialOf, DrawOrderIsSortThenRegistration) {
    files.addText("scripts/t.shader", "glow\n{\n{ map a\n blendFunc add\n }\n}\nnear\n{\nsort nearest\n{ map a }\n}\n"
                                      "glow2\n{\n{ map a\n blendFunc add\n }\n}\n");
    const MaterialId glow2 = library().find("glow2", -1), near = library().find("near", -1);
    const MaterialId glow = library().find("glow", -1), wall = library().find("a", -1);
    const auto rank = [&](MaterialId id) { return library().get(id).sortRank; };
    EXPECT_LT(rank(0), rank(wall));
    EXPECT_LT(rank(wall), rank(glow2));
    EXPECT_LT(rank(glow2), rank(glow));
    EXPECT_LT(rank(glow), rank(near));
    EXPECT_EQ(rank(near), library().count() - 1);
}

TEST_F(MaterialOf, CollapsesByTheTable) {
    struct Case {
        const char *first, *second;
        Combine combine;
    };
    const Case cases[] = {
        {"rgbGen identity", "blendFunc filter", Combine::Multiply},
        {"rgbGen identity", "blendFunc GL_ZERO GL_SRC_COLOR", Combine::Multiply},
        {"blendFunc filter", "blendFunc filter", Combine::Multiply},
        {"rgbGen identity", "blendFunc add\n rgbGen identity", Combine::Add},
        {"blendFunc add\n rgbGen identity", "blendFunc add\n rgbGen identity", Combine::Add},
        {"", "blendFunc add", Combine::Single}, // identityLighting may not be added
        {"rgbGen identity", "blendFunc blend\n rgbGen identity", Combine::Single},
        {"rgbGen vertex", "blendFunc filter\n rgbGen vertex", Combine::Multiply},
        {"rgbGen vertex", "blendFunc filter", Combine::Single},
        {"alphaFunc GE128\n rgbGen identity", "blendFunc filter", Combine::Single},
        {"alphaFunc GE128\n rgbGen identity", "blendFunc filter\n alphaFunc GE128", Combine::Multiply},
        {"rgbGen wave sin 1 0 0 1", "blendFunc filter\n rgbGen wave sin 1 0 0 1", Combine::Multiply},
        {"rgbGen wave sin 1 0 0 1", "blendFunc filter\n rgbGen wave sin 1 0 0 2", Combine::Single},
        {"rgbGen const ( 1 0 0 )", "blendFunc filter\n rgbGen const ( 0 1 0 )", Combine::Multiply},
        {"depthFunc equal\n rgbGen identity", "blendFunc filter", Combine::Single}};
    std::string text;
    for (size_t i = 0; i < std::size(cases); ++i)
        text += "t" + std::to_string(i) + "\n{\n{ map a\n " + cases[i].first + "\n}\n{ map b\n " + cases[i].second +
                "\n}\n{ map c\n blendFunc add\n }\n}\n";
    files.addText("scripts/t.shader", text);
    for (size_t i = 0; i < std::size(cases); ++i) {
        const Material& material = library().get(library().find("t" + std::to_string(i), -1));
        ASSERT_FALSE(material.isDefault);
        EXPECT_EQ(material.stages[0].combine, cases[i].combine) << cases[i].first << " | " << cases[i].second;
        EXPECT_EQ(material.stages.size(), cases[i].combine == Combine::Single ? 3u : 2u);
    }
}

TEST_F(MaterialOf, CollapsedConstantIsTheFirstStages) {
    define("{ map a\n rgbGen const ( 1 1 1 )\n }\n{ map b\n blendFunc filter\n rgbGen const ( 0.5 0.5 0.5 )\n }");
    EXPECT_EQ(compile().stages[0].constantColor, U8vec4(255));
}

TEST_F(MaterialOf, NoCollapseWithoutMultitexture) {
    settings.multitexture = false;
    define("{ map $lightmap\n rgbGen identity\n }\n{ map b\n blendFunc filter\n }");
    EXPECT_EQ(compile().stages.size(), 2u);
}

TEST_F(MaterialOf, LightmapGoesSecond) {
    define("{ map $lightmap\n rgbGen identity\n }\n{ map b\n blendFunc filter\n tcMod scale 2 2\n }");
    const Stage& stage = compile(1).stages[0];
    EXPECT_EQ(stage.unit[0].frames[0], textureOf("b"));
    EXPECT_EQ(stage.unit[0].mods.size(), 1u);
    EXPECT_TRUE(stage.unit[1].isLightmap);
    EXPECT_EQ(stage.unit[1].frames[0], textureOf("*lightmap1"));
    EXPECT_EQ(stage.unit[1].texCoordGen, TexCoordGen::Lightmap);
    EXPECT_EQ(stage.bakedLight, BakedLight::Lightmap);
    EXPECT_FALSE(stage.blended);
}

TEST_F(MaterialOf, WhiteFilterPairsMergeAtIdentityLightOneOnly) {
    define("{ map $lightmap\n }\n{ map b\n blendFunc filter\n }"); // identityLighting, identity: two passes originally
    EXPECT_EQ(compile().stages.size(), 1u);
    EXPECT_EQ(compile().stages[0].combine, Combine::Multiply);
}

TEST_F(MaterialOf, WhiteFilterPairsStayApartWithOverbright) {
    textureSettings.overbrightBits = 1;
    define("{ map $lightmap\n }\n{ map b\n blendFunc filter\n }");
    EXPECT_EQ(compile().stages.size(), 2u);
}

TEST_F(MaterialOf, DetailStagesGoWhereNotWanted) {
    settings.detailTextures = false;
    define("{ map a }\n{ map b\n blendFunc GL_DST_COLOR GL_SRC_COLOR\n detail\n }\n{ map c\n blendFunc add\n }");
    const Material& material = compile();
    ASSERT_EQ(material.stages.size(), 2u);
    EXPECT_EQ(material.stages[1].unit[0].frames[0], textureOf("c"));
}

TEST_F(MaterialOf, FogFadesOnlyOverABlendedFirstStage) {
    files.addText(
        "scripts/t.shader",
        "blend\n{\n{ map a\n blendFunc blend\n }\n{ map b\n blendFunc add\n }\n{ map c\n blendFunc filter\n }\n"
        "{ map d\n blendFunc GL_ONE GL_ONE_MINUS_SRC_ALPHA\n }\n"
        "{ map e\n blendFunc GL_ZERO GL_ONE_MINUS_SRC_COLOR\n }\n}\nopaque\n{\n{ map a }\n{ map b\n blendFunc add\n "
        "}\n}\n");
    const auto& s = library().get(library().find("blend", -1)).stages;
    ASSERT_EQ(s.size(), 5u);
    const FogFade expected[] = {FogFade::Alpha, FogFade::Rgb, FogFade::None, FogFade::Rgba, FogFade::Rgb};
    for (size_t i = 0; i < 5; ++i)
        EXPECT_EQ(s[i].fogFade, expected[i]) << i;
    EXPECT_EQ(library().get(library().find("opaque", -1)).stages[1].fogFade, FogFade::None);
}

TEST_F(MaterialOf, PlainImagesDependOnWhoAsks) {
    const auto stagesFor = [&](int lightmap) { return library().get(library().find("a", lightmap)).stages; };
    const auto none = stagesFor(lightmapContext::kNone);
    ASSERT_EQ(none.size(), 1u);
    EXPECT_EQ(none[0].rgbGen, RgbGen::LightingDiffuse);
    EXPECT_EQ(none[0].alphaGen, AlphaGen::Identity);
    EXPECT_EQ(none[0].bakedLight, BakedLight::LightGrid);
    const auto white = stagesFor(lightmapContext::kWhite);
    ASSERT_EQ(white.size(), 1u) << "white under a filter, merged";
    EXPECT_EQ(white[0].bakedLight, BakedLight::None);
    const auto vertex = stagesFor(lightmapContext::kByVertex);
    EXPECT_EQ(vertex[0].rgbGen, RgbGen::ExactVertex);
    EXPECT_EQ(vertex[0].alphaGen, AlphaGen::KeepFromRgb);
    EXPECT_EQ(vertex[0].bakedLight, BakedLight::VertexColor);
    const auto flat = stagesFor(lightmapContext::k2D);
    EXPECT_EQ(flat[0].rgbGen, RgbGen::Vertex);
    EXPECT_EQ(flat[0].bakedLight, BakedLight::None);
    EXPECT_EQ(flat[0].depthFunc, DepthFunc::Always);
    EXPECT_TRUE(flat[0].blended && !flat[0].depthWrite);
    EXPECT_EQ(library().get(library().find("a", lightmapContext::k2D)).sort, 9);
    const auto page = stagesFor(1);
    ASSERT_EQ(page.size(), 1u);
    EXPECT_EQ(page[0].combine, Combine::Multiply);
    EXPECT_TRUE(page[0].unit[1].isLightmap);
    EXPECT_NE(library().find("a", 0), library().find("a", 1));
    EXPECT_EQ(library().find("A.jpg", 1), library().find("a", 1)) << "extension and case do not tell materials apart";
}

TEST_F(MaterialOf, FirstRequestDecidesTheImageFlags) {
    const MaterialId id = library().find("a.tga", lightmapContext::k2D, false);
    EXPECT_EQ(library().find("a.tga", lightmapContext::k2D, true), id);
    const TextureFlags& flags = textures->get(library().get(id).stages[0].unit[0].frames[0]).flags;
    EXPECT_TRUE(flags.clamp && !flags.mipmap && !flags.picmip);
}

TEST_F(MaterialOf, NamesOfNoUse) {
    EXPECT_EQ(library().find("", 0), 0u);
    EXPECT_EQ(library().find(std::string(64, 'a'), 0), 0u);
    EXPECT_EQ(library().registerHandle("nowhere", -4), 0);
    EXPECT_TRUE(library().get(library().find("nowhere", -4)).isDefault);
    EXPECT_TRUE(library().get(0).isDefault);
    EXPECT_EQ(library().get(0).stages[0].unit[0].frames[0], builtinTexture::kDefault);
}

TEST_F(MaterialOf, LightmapIsWhiteWithoutAPage) {
    define("{ map $lightmap\n tcMod scale 2 2\n }\n{ map a\n blendFunc add\n }");
    const Stage& stage = compile(lightmapContext::kNone).stages[0];
    EXPECT_TRUE(stage.unit[0].isWhite && !stage.unit[0].isLightmap);
    EXPECT_EQ(stage.unit[0].texCoordGen, TexCoordGen::Lightmap);
    EXPECT_EQ(stage.bakedLight, BakedLight::None);
}

// T7 of the content survey: terrain whose names hold a percent sign, with vertex alpha.
TEST_F(MaterialOf, T7MetashaderNamesAreOrdinaryNames) {
    files.addText("scripts/t.shader",
                  "textures/%METASHADER_NAME%.vertex\n{\n{ map a }\n}\n"
                  "textures/terrain\n{\n{ map a\n rgbGen vertex\n alphaGen vertex\n blendFunc blend\n }\n}\n");
    // A label with an extension can never be found; remapping to it fails quietly.
    library().remap("textures/terrain", "textures/%METASHADER_NAME%.vertex", "0");
    const MaterialId terrain = library().find("textures/terrain", 0);
    EXPECT_EQ(library().drawnId(terrain), terrain);
    EXPECT_TRUE(library().get(library().find("textures/%METASHADER_NAME%.vertex", 0)).isDefault);
    EXPECT_EQ(library().get(terrain).stages[0].alphaGen, AlphaGen::Vertex);
}

// T8 of the content survey: a page is asked for, but no stage reads it.
TEST_F(MaterialOf, T8UnusedPageGivesCopiesWhereOrderShows) {
    files.addText("scripts/t.shader", "flame\n{\n{ map a\n blendFunc add\n }\n}\nwall\n{\n{ map a }\n}\n");
    const MaterialId wall = library().find("wall", 0);
    EXPECT_EQ(library().get(wall).lightmap, lightmapContext::kNone);
    EXPECT_EQ(library().find("wall", 1), wall) << "opaque: order does not show, one is enough";
    const MaterialId first = library().find("flame", 0), second = library().find("flame", 0);
    EXPECT_NE(first, second);
    EXPECT_EQ(library().get(second).sharedStages, first);
    EXPECT_LT(library().get(first).sortRank, library().get(second).sortRank);
    EXPECT_EQ(library().find("flame", lightmapContext::kNone), first);
}

TEST_F(MaterialOf, RemapRedirectsAllVariantsOneLevel) {
    const MaterialId a0 = library().find("a", 0), a1 = library().find("a", 1), b = library().find("b", 1);
    library().remap("a", "b", "2.5");
    EXPECT_EQ(library().drawnId(a0), b);
    EXPECT_EQ(library().drawnId(a1), b);
    EXPECT_EQ(library().drawn(a0).timeOffsetSeconds, 2.5);
    library().find("c", 0);
    library().remap("b", "c", nullptr);
    EXPECT_EQ(library().drawnId(a0), b) << "not chained";
    library().remap("a", "a", nullptr);
    EXPECT_EQ(library().drawnId(a1), a1) << "to itself: the variant found is restored";
    EXPECT_EQ(library().drawnId(a0), a1) << "and the others lead to it";
    library().remap("a", "missing", nullptr);
    EXPECT_EQ(library().drawnId(a0), a1);
}

TEST_F(MaterialOf, VertexLightKeepsOneStage) {
    settings.vertexLight = true;
    define("{ map $lightmap }\n{ map a\n blendFunc filter\n tcMod scale 2 2\n }\n{ map b\n blendFunc add\n }");
    const Material& material = compile(lightmapContext::kByVertex);
    ASSERT_EQ(material.stages.size(), 1u);
    EXPECT_EQ(material.stages[0].unit[0].frames[0], textureOf("b")) << "the tcMod ranks the other one lower";
    EXPECT_EQ(material.stages[0].rgbGen, RgbGen::ExactVertex);
    EXPECT_FALSE(material.stages[0].blended);
}

TEST_F(MaterialOf, ScriptsOfTheLastListedFileWin) {
    files.addText("scripts/one.shader", "s\n{\n{ map a }\n}\n");
    files.addText("scripts/two.shader", "s\n{\n{ map b }\n}\ns\n{\n{ map c }\n}\n");
    const TextureId drawn = compile(-1).stages[0].unit[0].frames[0];
    EXPECT_EQ(textures->get(drawn).name, "b");
}

} // namespace
} // namespace q3rt
