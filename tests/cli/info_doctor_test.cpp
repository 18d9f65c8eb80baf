#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "baseq3-test/test_maps.hpp"
#include "formats/pk3.hpp"
#include "support/game_data.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {

namespace {

/// A game folder with the test maps.
std::filesystem::path makeGameFolder() {
    const std::filesystem::path base = makeScratchFolder("game");
    std::filesystem::create_directories(base / "mygame");
    writePk3(base / "mygame" / "pak0.pk3", buildTestGameFiles());
    return base;
}

} // namespace

TEST(Info, CountsTheTestMaps) {
    const std::string base = makeGameFolder().string();
    const ProgramResult room =
        runQ3rt({"info", "--map", squareLightRoom::kName, "--basepath", base, "--game", "mygame", "--json"});
    ASSERT_EQ(room.exitCode, 0) << room.errors;
    const auto census = nlohmann::json::parse(room.output);
    EXPECT_EQ(census["faces"]["planar"], 14);
    EXPECT_EQ(census["faces"]["drawn"], 14);
    EXPECT_EQ(census["triangles"]["drawn"], 28);
    EXPECT_EQ(census["triangles"]["zero_area"], 0);
    EXPECT_EQ(census["materials"]["missing"], 0);
    EXPECT_EQ(census["clusters"], 1);
    EXPECT_EQ(census["lights"]["triangles"], 2);
    EXPECT_EQ(census["lights"]["emissive_faces"], 1);
    EXPECT_EQ(census["spawn_points"], 2);
    EXPECT_TRUE(census["requires"].empty());

    const ProgramResult corridor =
        runQ3rt({"info", "--map", threeClusterCorridor::kName, "--basepath", base, "--game", "mygame", "--json"});
    ASSERT_EQ(corridor.exitCode, 0) << corridor.errors;
    const auto lights = nlohmann::json::parse(corridor.output)["lights"];
    EXPECT_EQ(lights["triangles"], 6);
    // The outer clusters see 4 of the 6 triangles, the middle one all.
    EXPECT_NEAR(lights["triangles_seen_by_a_cluster"], (4 + 6 + 4) / 3.0, 1e-9);
}

TEST(Info, RecoveredLightsAreComparedWithLuxels) {
    const std::filesystem::path base = makeGameFolder();
    std::filesystem::create_directories(base / "mygame" / "lights");
    std::ofstream(base / "mygame" / "lights" / (std::string(squareLightRoom::kName) + ".ent"))
        << R"({ "classname" "light" "origin" "0 0 64" "light" "300" })";
    const auto meanOfPoints = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"info",   "--map",  squareLightRoom::kName, "--luxels",   "--json",
                                              "--game", "mygame", "--basepath",           base.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = runQ3rt(arguments);
        EXPECT_EQ(result.exitCode, 0) << result.errors;
        return nlohmann::json::parse(result.output).at("mean_points").get<double>();
    };
    EXPECT_EQ(meanOfPoints({}), 0);
    EXPECT_GT(meanOfPoints({"--recovered"}), 0);
}

TEST(Info, BadInputIsOneLine) {
    const std::string base = makeGameFolder().string();
    ProgramResult result = runQ3rt({"info", "--map", "absent", "--basepath", base, "--game", "mygame"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("absent")) << result.errors;
    result = runQ3rt({"info", "--map", "oa_dm1", "--basepath", base, "--game", "nogame"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("nogame")) << result.errors;
    EXPECT_EQ(runQ3rt({"info"}).exitCode, 2);
}

TEST(Info, OneDamagedMapDoesNotHideTheOthers) {
    const std::filesystem::path base = makeGameFolder();
    std::filesystem::create_directories(base / "mygame" / "maps");
    std::ofstream(base / "mygame" / "maps" / "broken.bsp") << "IBSP";
    const ProgramResult all = runQ3rt({"info", "--all", "--basepath", base.string(), "--game", "mygame", "--json"});
    EXPECT_EQ(all.exitCode, 1);
    EXPECT_NE(all.output.find(squareLightRoom::kName), std::string::npos) << all.output;
    EXPECT_NE(all.errors.find("maps/broken.bsp: ends too early"), std::string::npos) << all.errors;
    EXPECT_NE(all.errors.find("1 of 3 maps can't be counted"), std::string::npos) << all.errors;
}

TEST(Info, CountsAMapOfTheGame) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    const ProgramResult result = runQ3rt({"info", "--map", "oa_shouse", "--json"});
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const auto census = nlohmann::json::parse(result.output);
    EXPECT_EQ(census["faces"]["planar"], 1478);
    EXPECT_EQ(census["faces"]["patch"], 279);
    EXPECT_EQ(census["faces"]["flare"], 18);
    EXPECT_EQ(census["clusters"], 897);
    EXPECT_EQ(census["lightmap_pages"], 16);
    EXPECT_EQ(census["lights"]["suns"], 1);
    EXPECT_EQ(census["requires"]["sky"], 5);
}

TEST(Doctor, ReportsWhatIsThere) {
    const ProgramResult result = runQ3rt({"doctor", "--json"});
    const auto report = nlohmann::json::parse(result.output);
    EXPECT_EQ(result.exitCode, report["playable"] ? 0 : 1);
    EXPECT_GE(report["checks"].size(), 7u);
    for (const auto& check : report["checks"])
        EXPECT_FALSE(check["finding"] == "problem" && check["remedy"] == "") << check;
}

TEST(Doctor, FindsTheFetchedDriverByItself) {
    const char* icd = std::getenv("VK_DRIVER_FILES");
    if (!icd || !std::filesystem::exists(icd)) GTEST_SKIP() << "needs VK_DRIVER_FILES=$(scripts/lavapipe.sh)";
    const std::filesystem::path cache = makeScratchFolder("driver cache");
    const std::vector<std::string> plainShell = {
        "VK_DRIVER_FILES=", "VK_ADD_DRIVER_FILES=", "VK_ICD_FILENAMES=", "XDG_CACHE_HOME=" + cache.string()};
    const auto countDevices = [&] {
        size_t count = 0;
        const auto report = nlohmann::json::parse(runQ3rt({"doctor", "--json"}, plainShell).output);
        for (const auto& check : report["checks"])
            count += check["subject"] == "device";
        return count;
    };
    const size_t before = countDevices();
    // Links beside each other, as scripts/lavapipe.sh lays the files: the path of the library in the .json is relative.
    std::filesystem::create_directories(cache / "q3rt");
    std::filesystem::create_directory_symlink(std::filesystem::path(icd).parent_path(), cache / "q3rt" / "lavapipe");
    if (!std::filesystem::exists(cache / "q3rt" / "lavapipe" / "lvp_icd.json"))
        GTEST_SKIP() << "the driver is the system's: there is none to fetch";
    EXPECT_EQ(countDevices(), before + 1);
    const std::string text = runQ3rt({"doctor"}, plainShell).output;
    EXPECT_NE(text.find("added to the machine's own"), std::string::npos) << text;
    std::vector<std::string> named = plainShell;
    named[0] = "VK_DRIVER_FILES=" + std::string(icd);
    EXPECT_NE(runQ3rt({"doctor"}, named).output.find("not added, the environment names drivers"), std::string::npos);
}

TEST(Doctor, MissingThingsHaveRemedies) {
    const std::filesystem::path empty = makeScratchFolder("empty");
    ProgramResult result = runQ3rt({"doctor", "--basepath", empty.string()});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.output.find("no pk3 archives"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("apt-get install openarena-data"), std::string::npos) << result.output;

    result = runQ3rt({"doctor"}, {"VK_DRIVER_FILES=/nonexistent.json", "VK_ADD_DRIVER_FILES="});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.output.find("problem  Vulkan"), std::string::npos) << result.output;

    writeFile(empty / "baseoa" / "damaged.pk3", std::vector<std::byte>(1000));
    result = runQ3rt({"doctor", "--basepath", empty.string()});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.output.find("damaged.pk3"), std::string::npos) << result.output;

    result = runQ3rt({"doctor", "--out", "/proc/nowhere"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_NE(result.output.find("can't be written"), std::string::npos) << result.output;
}

} // namespace q3rt::test
