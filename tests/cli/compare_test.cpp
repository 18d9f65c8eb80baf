#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "formats/image.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {

namespace {

std::vector<uint8_t> makeGradient(int width, int height, int offset) {
    std::vector<uint8_t> rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                rgb.push_back(static_cast<uint8_t>((x * 5 + y * 3 + c * 20) % 200 + offset));
    return rgb;
}

struct CompareFiles : testing::Test {
    std::filesystem::path folder = makeScratchFolder("compare");
    std::string png = (folder / "a.png").string(), brighter = (folder / "b.png").string();
    std::string tga = (folder / "a.tga").string(), small = (folder / "small.png").string();
    std::string pfm = (folder / "a.pfm").string();

    void SetUp() override {
        writeFile(png, encodePng(32, 24, 3, makeGradient(32, 24, 0)));
        writeFile(brighter, encodePng(32, 24, 3, makeGradient(32, 24, 51)));
        writeFile(tga, encodeTga24(32, 24, makeGradient(32, 24, 0)));
        writeFile(small, encodePng(16, 24, 3, makeGradient(16, 24, 0)));
        std::vector<float> floats;
        for (const uint8_t byte : makeGradient(32, 24, 0))
            floats.push_back(static_cast<float>(byte) / 255.0f);
        writeFile(pfm, encodePfm(32, 24, floats));
    }
};

} // namespace

TEST_F(CompareFiles, EqualPicturesInAnyFormat) {
    for (const std::string& other : {png, tga}) {
        const ProgramResult result = runQ3rt({"compare", png, other});
        ASSERT_EQ(result.exitCode, 0) << result.errors;
        const auto json = nlohmann::json::parse(result.output);
        EXPECT_EQ(json["ssim"], 1.0);
        EXPECT_EQ(json["flip"], 0.0);
        EXPECT_TRUE(json["psnr"].is_null());
        EXPECT_EQ(json["mse"], 0.0);
        EXPECT_EQ(json["relmse"], 0.0);
    }
    const auto floats = nlohmann::json::parse(runQ3rt({"compare", png, pfm}).output);
    EXPECT_LT(floats["mse"], 1e-14);
}

TEST_F(CompareFiles, KnownDifferenceAndHeatmap) {
    const std::string heatmap = (folder / "new" / "heat.png").string();
    const ProgramResult result = runQ3rt({"compare", png, brighter, "--heatmap", heatmap});
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const auto json = nlohmann::json::parse(result.output);
    EXPECT_NEAR(json["mse"], 0.04, 1e-8); // (51 / 255)^2
    EXPECT_NEAR(json["psnr"], -10 * std::log10(0.04), 1e-6);
    EXPECT_GT(json["flip"], 0.05);
    EXPECT_TRUE(std::filesystem::exists(heatmap));
}

TEST_F(CompareFiles, BadInputIsOneLine) {
    ProgramResult result = runQ3rt({"compare", png, small});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("small.png has 16 x 24")) << result.errors;
    result = runQ3rt({"compare", png, "absent.png"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("absent.png")) << result.errors;
    writeFile(folder / "broken.png", std::vector<std::byte>(100));
    result = runQ3rt({"compare", (folder / "broken.png").string(), png});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("broken.png")) << result.errors;
    EXPECT_EQ(runQ3rt({"compare", png}).exitCode, 2);
    EXPECT_EQ(runQ3rt({"compare", png, png, "--ppd", "0"}).exitCode, 2);
    EXPECT_EQ(runQ3rt({"compare", "--help"}).exitCode, 0);
}

} // namespace q3rt::test
