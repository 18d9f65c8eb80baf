// OpenEXR pictures: what is written is read again bit by bit; damaged files are refused with their name.

#include "host/common/exr_file.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {
namespace {

FloatImage makeImage(int width, int height) {
    FloatImage image{width, height, {}};
    std::mt19937 random(7);
    std::lognormal_distribution<float> radiance(0, 3);
    for (int i = 0; i < width * height * 3; ++i)
        image.rgb.push_back(radiance(random));
    return image;
}

TEST(Exr, KeepsEveryFloat) {
    FloatImage image = makeImage(37, 21);
    image.rgb[0] = 0;
    image.rgb[1] = -1.5f;
    image.rgb[2] = std::numeric_limits<float>::denorm_min();
    image.rgb[3] = std::numeric_limits<float>::max();
    const std::vector<std::byte> file = encodeExr(image, "unit");
    const FloatImage again = decodeExr(file, "a.exr");
    EXPECT_EQ(again.width, 37);
    EXPECT_EQ(again.height, 21);
    EXPECT_EQ(again.rgb, image.rgb);
    EXPECT_EQ(encodeExr(again, "unit"), file);
}

TEST(Exr, DamagedFilesAreRefusedByName) {
    const std::vector<std::byte> good = encodeExr(makeImage(40, 40), "unit");
    int refused = 0, cases = 0;
    const auto tryFile = [&](const std::vector<std::byte>& file) {
        ++cases;
        try {
            decodeExr(file, "bad.exr");
        } catch (const ContentError& error) {
            ++refused;
            EXPECT_EQ(std::string(error.what()).find("bad.exr: "), 0u) << error.what();
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    };
    for (size_t length = 0; length < good.size(); length += 97)
        tryFile({good.begin(), good.begin() + static_cast<ptrdiff_t>(length)});
    EXPECT_EQ(refused, cases);
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i) {
        std::vector<std::byte> file = good;
        for (int k = 0; k < 4; ++k)
            file[random() % std::min<size_t>(file.size(), 400)] = static_cast<std::byte>(random());
        tryFile(file);
    }
    EXPECT_GT(refused, 100);
}

TEST(Exr, ComparesLikeTheSameFloatsInPfm) {
    const std::filesystem::path folder = makeScratchFolder("exr");
    const FloatImage image = makeImage(32, 24);
    FloatImage brighter = image;
    for (float& value : brighter.rgb)
        value *= 1.25f;
    writeFile(folder / "a.exr", encodeExr(image, "unit"));
    writeFile(folder / "b.exr", encodeExr(brighter, "unit"));
    writeFile(folder / "a.pfm", encodePfm(32, 24, image.rgb));
    writeFile(folder / "b.pfm", encodePfm(32, 24, brighter.rgb));
    const auto compare = [&](const char* a, const char* b) {
        return runQ3rt({"compare", (folder / a).string(), (folder / b).string()});
    };
    EXPECT_EQ(compare("a.exr", "b.exr").output, compare("a.pfm", "b.pfm").output);
    EXPECT_EQ(nlohmann::json::parse(compare("a.exr", "a.pfm").output)["mse"], 0.0);
    writeFile(folder / "broken.exr", std::vector<std::byte>(500));
    EXPECT_TRUE(compare("a.exr", "broken.exr").saysInOneLine("broken.exr"));
}

} // namespace
} // namespace q3rt::test
