// A small part of the comparison with the original, by the program that makes the whole of it.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <gtest/gtest.h>

#include "formats/image.hpp"
#include "host/common/file_bytes.hpp"
#include "support/game_data.hpp"
#include "tool/likeness.hpp"

namespace q3rt::test {

namespace {

namespace fs = std::filesystem;

struct Folder {
    fs::path path = fs::temp_directory_path() / ("q3rt-parity-test." + std::to_string(getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

void writePicture(const fs::path& path, int size, uint8_t first, uint8_t second) {
    std::vector<uint8_t> rgb;
    for (int i = 0; i < size * size; ++i)
        rgb.insert(rgb.end(), 3, i % 3 == 0 ? first : second);
    writeFileBytes(path, encodePng(size, size, 3, rgb));
}

} // namespace

TEST(Parity, LikenessTellsEqualFromOtherAndFromMissing) {
    const Folder folder;
    for (const char* picture : {"same", "other"})
        writePicture(folder.path / "reference" / (std::string(picture) + ".png"), 32, 200, 20);
    writePicture(folder.path / "test" / "same.png", 32, 200, 20);
    writePicture(folder.path / "test" / "other.png", 32, 20, 200);
    const auto found = parity::comparePictures(folder.path, "map", {"same", "other", "missing"});
    ASSERT_EQ(found.size(), 3u);
    EXPECT_NEAR(found[0].ssim, 1, 1e-9);
    EXPECT_LT(found[1].ssim, 0.9);
    EXPECT_EQ(found[2].ssim, -1);
    EXPECT_TRUE(parity::isWithin({found[0]}, 0.995, 0.97));
    EXPECT_FALSE(parity::isWithin(found, 0.995, 0.97));
    const fs::path file = folder.path / "likeness.txt";
    parity::writeLikeness(file, found);
    const auto again = parity::readLikeness(file, "map");
    ASSERT_EQ(again.size(), found.size());
    EXPECT_EQ(again[2].picture, "missing");
    EXPECT_NE(parity::describeLikeness(found, 3).find("1. map missing"), std::string::npos);
}

TEST(Parity, MapsLookLikeTheOriginal) {
    if (!findGameFolder()) GTEST_SKIP() << kNoGameData;
    if (std::system("command -v xvfb-run >/dev/null") != 0) GTEST_SKIP() << "xvfb-run is not installed";
    const Folder folder;
    const std::string command = std::string(Q3RT_BUILD_DIR) + "/compare_rasters --out '" + folder.path.string() +
                                "' --map oa_dm1 --map fan --map q3dm6ish --cameras 1 --size 320x240 >" +
                                (folder.path / "log").string() + " 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(fs::exists(folder.path / "worst.jpg"));
}

} // namespace q3rt::test
