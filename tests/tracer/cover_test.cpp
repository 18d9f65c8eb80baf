// Alpha tests told by one texel, and those that take a material's stages: the same holes, seen and shone through.

#include <gtest/gtest.h>
#include <random>

#include "renderer_rt/surface_class.hpp"
#include "shaders/shared/rt_scene.h"
#include "truth/picture_statistics.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {
namespace {

StageState testedState() {
    StageState stage{};
    stage.color = vec4(1);
    stage.alphaTest = kTestGreaterEqual128;
    stage.depthWrite = 1;
    stage.unit[0].texture = 7;
    return stage;
}

TEST(Cover, OfOneTexelIsToldByIt) {
    StageState tested = testedState(), lightmap{};
    lightmap.blended = 1;
    lightmap.depthEqual = 1;
    EXPECT_EQ(coverOf(std::vector{tested, lightmap}), 7u << kCoverTextureShift | kTestGreaterEqual128);
    tested.unit[0].clamped = 1;
    EXPECT_EQ(coverOf(std::vector{tested}), 7u << kCoverTextureShift | kCoverClamped | kTestGreaterEqual128);
}

TEST(Cover, OfMoreThanOneTexelTakesTheStages) {
    const auto changed = [](auto change) {
        StageState stage = testedState();
        change(stage);
        return coverOf(std::vector{stage});
    };
    EXPECT_NE(changed([](StageState&) {}), 0u);
    EXPECT_EQ(changed([](StageState& s) { s.unit[0].modCount = 1; }), 0u);
    EXPECT_EQ(changed([](StageState& s) { s.unit[0].coord = kCoordEnvironment; }), 0u);
    EXPECT_EQ(changed([](StageState& s) { s.alphaGen = kAlphaVertex; }), 0u);
    EXPECT_EQ(changed([](StageState& s) { s.color.a = 0.5f; }), 0u);
    EXPECT_EQ(changed([](StageState& s) { s.combine = kCombineMultiply; }), 0u);
    EXPECT_EQ(changed([](StageState& s) { s.alphaTest = kTestNone; }), 0u);
    EXPECT_EQ(coverOf(std::vector{testedState(), testedState()}), 0u) << "either may cover";
    EXPECT_EQ(coverOf({}), 0u);
}

constexpr int kWidth = 96, kHeight = 72; ///< pixels
const Camera kDown{.eye = {0, 0, 120}, .pitch = 90, .fovX = 60};

/// The vertices' alpha is 1: both with holes tell the same.
constexpr const char* kScripts =
    "solid\n{\ncull none\n{\nmap holes.tga\nrgbGen vertex\n}\n}\n"
    "quick\n{\ncull none\n{\nmap holes.tga\nrgbGen vertex\nalphaFunc GE128\n}\n}\n"
    "staged\n{\ncull none\n{\nmap holes.tga\nrgbGen vertex\nalphaFunc GE128\nalphaGen vertex\n}\n}\n";

/// Uncompressed TGA, 32 bits: 4 x 4 squares of 4 texels, every second one a hole.
std::vector<std::byte> makeHoles() {
    constexpr uint8_t kSide = 16;
    std::vector<uint8_t> bytes = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, kSide, 0, kSide, 0, 32, 8};
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x)
            bytes.insert(bytes.end(), {200, 200, 200, static_cast<uint8_t>((x / 4 + y / 4) % 2 ? 255 : 0)});
    std::vector<std::byte> result(bytes.size());
    std::transform(bytes.begin(), bytes.end(), result.begin(), [](uint8_t b) { return std::byte(b); });
    return result;
}

/// A stack of sheets over the floor; every third one lies in the plane of the one before and has its colour.
std::vector<TraceHarness::Quad> makeSheets(qhandle_t shader) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-30, 30), height(10, 90), scale(1, 3);
    std::vector<TraceHarness::Quad> sheets;
    for (int n = 0; n < 15; ++n) {
        TraceHarness::Quad quad{.shader = shader};
        const float x = place(random), y = place(random), s = scale(random);
        const float z = n % 3 == 2 ? sheets.back().vertices[0].xyz[2] : height(random);
        const float corners[4][2] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
        for (int i = 0; i < 4; ++i) {
            polyVert_t& vertex = quad.vertices[i];
            vertex.xyz[0] = x + 60 * (corners[i][0] - 0.5f);
            vertex.xyz[1] = y + 60 * (corners[i][1] - 0.5f);
            vertex.xyz[2] = z;
            vertex.st[0] = s * corners[i][0];
            vertex.st[1] = s * corners[i][1];
            for (int c = 0; c < 3; ++c)
                vertex.modulate[c] =
                    static_cast<byte>(n % 3 == 2 ? sheets.back().vertices[0].modulate[c] : 255 - 16 * n);
            vertex.modulate[3] = 255;
        }
        sheets.push_back(quad);
    }
    return sheets;
}

/// A program of its own, so that its random numbers are those of its first frame.
FloatImage drawRoom(const char* sheets) {
    TestGame game;
    game.addText("scripts/cover.shader", kScripts);
    game.add("holes.tga", makeHoles());
    TraceHarness harness(game, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kWidth, kHeight);
    harness.set("rt_seed", "1");
    prepareHarness(harness, squareLightRoom::kName, {{"rt_numRandomDL", "0"}});
    qhandle_t shader = 0;
    harness.engine().enter([&](const refexport_t& module) { shader = module.RegisterShader(sheets); });
    harness.setQuads(makeSheets(shader));
    return harness.radiance(kDown, 1);
}

size_t differingPixels(const FloatImage& a, const FloatImage& b, float bound) {
    size_t count = 0;
    for (size_t i = 0; i < a.rgb.size(); i += 3)
        count += std::abs(a.rgb[i] - b.rgb[i]) > bound;
    return count;
}

TEST(Cover, IsTheSameToldEitherWay) {
    const FloatImage solid = drawRoom("solid"), quick = drawRoom("quick"), staged = drawRoom("staged");
    EXPECT_GT(differingPixels(solid, quick, 1e-2f), size_t(kWidth) * kHeight / 5) << "holes show";
    EXPECT_EQ(differingPixels(quick, staged, 0), 0u);
}

} // namespace
} // namespace q3rt::test
