// Maps: what is read, and that no damaged map gets past the parser.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "base/error.hpp"
#include "formats/bsp.hpp"
#include "formats/entities.hpp"
#include "support/tiny_files.hpp"

namespace q3rt {
namespace {

using test::TinyBsp;

std::string errorOf(const std::vector<std::byte>& file) {
    try {
        parseBsp(file, "maps/tiny.bsp");
    } catch (const ContentError& error) {
        return error.what();
    }
    return "";
}

TEST(Bsp, ReadsEveryLump) {
    const Bsp bsp = parseBsp(TinyBsp().build(), "maps/tiny.bsp");
    EXPECT_EQ(bsp.entities, "{ \"classname\" \"worldspawn\" }\n");
    ASSERT_EQ(bsp.shaders.size(), 1u);
    EXPECT_EQ(bsp.shaders[0].name, "textures/a/b");
    EXPECT_EQ(bsp.shaders[0].contentFlags, 1u);
    ASSERT_EQ(bsp.planes.size(), 2u);
    EXPECT_EQ(bsp.planes[1].normal, vec3(0, 0, -1));
    ASSERT_EQ(bsp.nodes.size(), 1u);
    EXPECT_EQ(bsp.nodes[0].children[1], -2);
    EXPECT_EQ(bsp.nodes[0].maxs, ivec3(64));
    ASSERT_EQ(bsp.leafs.size(), 2u);
    EXPECT_EQ(bsp.leafs[1].cluster, 1);
    EXPECT_EQ(bsp.leafs[1].leafBrushCount, 1);
    EXPECT_EQ(bsp.leafSurfaces, (std::vector<int>{0, 1}));
    EXPECT_EQ(bsp.leafBrushes, std::vector<int>{0});
    ASSERT_EQ(bsp.models.size(), 1u);
    EXPECT_EQ(bsp.models[0].surfaceCount, 2);
    EXPECT_EQ(bsp.models[0].mins, vec3(-64));
    EXPECT_EQ(bsp.brushes.at(0).sideCount, 6);
    EXPECT_EQ(bsp.brushSides.size(), 6u);
    ASSERT_EQ(bsp.vertices.size(), 13u);
    EXPECT_EQ(bsp.vertices[2].position, vec3(64, 64, 0));
    EXPECT_EQ(bsp.vertices[2].st, vec2(1, 1));
    EXPECT_EQ(bsp.vertices[2].lightmapSt, vec2(0.25f, 0.75f));
    EXPECT_EQ(bsp.vertices[2].normal, vec3(0, 0, 1));
    EXPECT_EQ(bsp.vertices[2].color, U8vec4(0x20, 0x40, 0x80, 0xFF));
    EXPECT_EQ(bsp.indices, (std::vector<int>{0, 2, 1, 0, 3, 2}));
    ASSERT_EQ(bsp.fogs.size(), 1u);
    EXPECT_EQ(bsp.fogs[0].visibleSide, 5);
    ASSERT_EQ(bsp.surfaces.size(), 2u);
    EXPECT_EQ(bsp.surfaces[0].type, BspSurfaceType::Planar);
    EXPECT_EQ(bsp.surfaces[0].lightmapVectors[2], vec3(0, 0, 1));
    EXPECT_EQ(bsp.surfaces[1].patchWidth, 3);
    EXPECT_EQ(bsp.lightmapPageCount(), 1u);
    EXPECT_EQ(bsp.lightGrid.size(), 8u);
}

TEST(Bsp, VisibilityBits) {
    TinyBsp tiny;
    const Bsp bsp = parseBsp(tiny.build(), "t");
    EXPECT_TRUE(bsp.clusterVisible(0, 0));
    EXPECT_FALSE(bsp.clusterVisible(0, 1));
    EXPECT_TRUE(bsp.clusterVisible(1, 0));
    EXPECT_TRUE(bsp.clusterVisible(-1, 1));
    EXPECT_TRUE(bsp.clusterVisible(0, -1));
    tiny.lumps[16].clear();
    EXPECT_TRUE(parseBsp(tiny.build(), "t").clusterVisible(0, 1));
}

TEST(Bsp, T2GarbageLightmapCoordinatesBecomeZero) {
    TinyBsp tiny;
    tiny.set(10, 20, std::numeric_limits<float>::quiet_NaN());
    tiny.set(10, 44 + 24, std::numeric_limits<float>::infinity());
    const Bsp bsp = parseBsp(tiny.build(), "t");
    EXPECT_EQ(bsp.vertices[0].lightmapSt, vec2(0.0f, 0.75f));
    EXPECT_EQ(bsp.vertices[1].lightmapSt, vec2(0.25f, 0.0f));
}

TEST(Bsp, AFlareMayNameAFogThatDoesNotExist) {
    TinyBsp tiny;
    tiny.set(13, 4, 9);
    EXPECT_NE(errorOf(tiny.build()), "");
    tiny.set(13, 8, 4);
    EXPECT_EQ(parseBsp(tiny.build(), "t").surfaces[0].fog, -1);
}

TEST(Bsp, AWrongIdentifierOrVersionIsNamed) {
    TinyBsp tiny;
    tiny.version = 47;
    EXPECT_NE(errorOf(tiny.build()).find("version 47"), std::string::npos);
    EXPECT_NE(errorOf(std::vector<std::byte>(200)).find("no IBSP"), std::string::npos);
    EXPECT_NE(errorOf({}).find("maps/tiny.bsp"), std::string::npos);
}

TEST(Bsp, EveryTruncationIsRefused) {
    const std::vector<std::byte> whole = TinyBsp().build();
    size_t checked = 0;
    // The last lump ends the file, so any cut leaves some lump outside of it.
    for (size_t length = 0; length < whole.size(); length += length < 2000 ? 1 : 97, ++checked)
        EXPECT_NE(errorOf({whole.begin(), whole.begin() + static_cast<long>(length)}), "") << length;
    EXPECT_GT(checked, 2000u);
}

TEST(Bsp, DamageIsRefusedWithTheNameOfTheLump) {
    struct Case {
        const char* lump;
        std::function<void(TinyBsp&)> damage;
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Case cases[] = {
        {"SHADERS", [](TinyBsp& t) { t.lumps[1].pop_back(); }},
        {"PLANES", [=](TinyBsp& t) { t.set(2, 0, nan); }},
        {"NODES", [](TinyBsp& t) { t.set(3, 0, 2); }},
        {"NODES", [](TinyBsp& t) { t.set(3, 4, 1); }},
        {"NODES", [](TinyBsp& t) { t.set(3, 4, -3); }},
        {"NODES", [](TinyBsp& t) { t.set(3, 4, std::numeric_limits<int>::min()); }},
        {"NODES", [](TinyBsp& t) { t.set(3, 4, 0); }}, // its own child
        {"NODES", [](TinyBsp& t) { t.lumps[3].clear(); }},
        {"LEAFS", [](TinyBsp& t) { t.set(4, 0, 2); }},
        {"LEAFS", [](TinyBsp& t) { t.set(4, 32, 1); }},
        {"LEAFS", [](TinyBsp& t) { t.set(4, 36, -1); }},
        {"LEAFS", [](TinyBsp& t) { t.set(4, 44, 2); }},
        {"LEAFSURFACES", [](TinyBsp& t) { t.set(5, 0, 2); }},
        {"LEAFBRUSHES", [](TinyBsp& t) { t.set(6, 0, -1); }},
        {"MODELS", [](TinyBsp& t) { t.lumps[7].clear(); }},
        {"MODELS", [](TinyBsp& t) { t.set(7, 28, 3); }},
        {"MODELS", [](TinyBsp& t) { t.set(7, 24, std::numeric_limits<int>::max()); }},
        {"MODELS", [=](TinyBsp& t) { t.set(7, 0, nan); }},
        {"BRUSHES", [](TinyBsp& t) { t.set(8, 4, 7); }},
        {"BRUSHES", [](TinyBsp& t) { t.set(8, 8, 1); }},
        {"BRUSHSIDES", [](TinyBsp& t) { t.set(9, 0, 2); }},
        {"DRAWVERTS", [=](TinyBsp& t) { t.set(10, 0, nan); }},
        {"DRAWVERTS", [](TinyBsp& t) { t.lumps[10].push_back(std::byte{0}); }},
        {"DRAWINDEXES", [](TinyBsp& t) { t.set(11, 4, 4); }},
        {"DRAWINDEXES", [](TinyBsp& t) { t.set(11, 4, -1); }},
        {"FOGS", [](TinyBsp& t) { t.set(12, 64, 1); }},
        {"FOGS", [](TinyBsp& t) { t.set(12, 68, 6); }},
        {"FOGS", [](TinyBsp& t) { t.set(8, 4, 5); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 0, 1); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 4, 1); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 8, 5); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 12, std::numeric_limits<int>::max()); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 16, 14); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 20, 1); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 24, 5); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 104 + 96, 2); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 104 + 96, 5); }},
        {"SURFACES", [](TinyBsp& t) { t.set(13, 104 + 96, 0x10001); }},
        {"VISIBILITY", [](TinyBsp& t) { t.set(16, 0, 3); }},
        {"VISIBILITY", [](TinyBsp& t) { t.set(16, 0, 9); }},
        {"VISIBILITY", [](TinyBsp& t) { t.set(16, 4, 0x40000000); }},
        {"VISIBILITY", [](TinyBsp& t) { t.set(16, 4, -1); }},
        {"VISIBILITY", [](TinyBsp& t) { t.lumps[16].resize(7); }},
    };
    size_t checked = 0;
    for (const Case& c : cases) {
        TinyBsp tiny;
        c.damage(tiny);
        const std::string error = errorOf(tiny.build());
        EXPECT_TRUE(error.starts_with("maps/tiny.bsp: ")) << "case " << checked << ": '" << error << "'";
        EXPECT_NE(error.find(c.lump), std::string::npos) << "case " << checked << ": " << error;
        ++checked;
    }
    EXPECT_EQ(checked, 43u);
}

TEST(Bsp, ALumpOutsideTheFileIsNamed) {
    std::vector<std::byte> file = TinyBsp().build();
    test::overwrite(file, 8 + 8 * 10, uint32_t{0xFFFFFFFF});
    EXPECT_NE(errorOf(file).find("DRAWVERTS"), std::string::npos);
}

TEST(Entities, KeysAnyCaseNumbersAndVectors) {
    const auto entities =
        parseEntities("{\n\"ClassName\" \"light\" \"origin\" \"1 -2.5 3\"\n\"light\" \"300\" // x\n}\n{ }");
    ASSERT_EQ(entities.size(), 2u);
    EXPECT_EQ(entities[0].className(), "light");
    EXPECT_EQ(entities[0].pairs[0].first, "ClassName");
    EXPECT_EQ(entities[0].vector("Origin"), vec3(1, -2.5f, 3));
    EXPECT_EQ(entities[0].number("light", 0), 300.0f);
    EXPECT_EQ(entities[0].number("radius", 7), 7.0f);
    EXPECT_EQ(entities[0].value("none"), std::nullopt);
    EXPECT_EQ(entities[0].vector("light"), std::nullopt);
}

TEST(Entities, AMalformedBlockEndsTheList) {
    EXPECT_EQ(parseEntities("{ \"a\" \"b\" } { \"c\" ").size(), 1u);
    EXPECT_EQ(parseEntities("{ \"a\" \"b\" } { \"c\" } { }").size(), 1u);
    EXPECT_EQ(parseEntities("{ \"a\" \"b\" } x { }").size(), 1u);
    EXPECT_TRUE(parseEntities("").empty());
}

} // namespace
} // namespace q3rt
