// q3rt relight: the file it leaves, and what becomes of work that was broken off.

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bad_input.hpp"
#include "scene/lost_lights.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

std::string readText(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class RelightCommand : public testing::Test {
  protected:
    fs::path m_in = makeScratchFolder("relight_in"), m_out = makeScratchFolder("relight_out");

    void SetUp() override { makeBadInput(m_in); }
    ProgramResult run(std::vector<std::string> more) const {
        std::vector<std::string> words = {"relight", "--basepath", (m_in / "good").string(), "--budget", "8",
                                          "--out",   m_out};
        words.insert(words.end(), more.begin(), more.end());
        return runQ3rt(words);
    }
    fs::path file() const { return m_out / (std::string(kBadMap) + ".ent"); }
};

TEST_F(RelightCommand, LeavesAFileThatReadsBack) {
    const ProgramResult result = run({"--map", kBadMap, "--json"});
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const auto line = nlohmann::json::parse(result.output);
    EXPECT_EQ(line["map"], kBadMap);
    EXPECT_EQ(line["file"], file().string());
    EXPECT_GE(line["after"]["correlation"], 0.9);
    EXPECT_FALSE(line["curve"].empty());
    const LostLights lights = parseLostLights(readText(file()), file().string());
    EXPECT_EQ(lights.points.size(), line["lights"]);
    EXPECT_EQ(lights.stage, 0u);
    EXPECT_EQ(std::distance(fs::directory_iterator(m_out), {}), 1);
}

TEST_F(RelightCommand, AllGoesOnWhereItWasBrokenOff) {
    ASSERT_EQ(run({"--all"}).exitCode, 0);
    const std::string text = readText(file());
    ASSERT_FALSE(text.empty());
    const auto written = fs::last_write_time(file());
    EXPECT_EQ(run({"--all"}).output, "") << "nothing is left to do";
    EXPECT_EQ(fs::last_write_time(file()), written);
    // A file of another bake, or a damaged one, counts as none.
    std::ofstream(file()) << "nonsense";
    const ProgramResult again = run({"--all"});
    EXPECT_EQ(again.exitCode, 0);
    EXPECT_NE(again.errors.find("line 1: 'nonsense'"), std::string::npos) << again.errors;
    EXPECT_EQ(readText(file()), text);
}

TEST_F(RelightCommand, PlayMakesTheFileBeforeTheGameStarts) {
    const fs::path cache = makeScratchFolder("relight_cache");
    const fs::path made = cache / "q3rt" / "home" / "baseoa" / "lights" / (std::string(kBadMap) + ".ent");
    const auto play = [&] {
        return runQ3rt({"play", "--map", kBadMap, "--relight", "--headless", "--renderer", "null", "--frames", "1",
                        "--basepath", (m_in / "good").string()},
                       {"XDG_CACHE_HOME=" + cache.string()});
    };
    EXPECT_EQ(play().exitCode, 1) << "the folder holds a map, and no game to play on it";
    EXPECT_EQ(parseLostLights(readText(made), made.string()).stage, 0u);
    const auto written = fs::last_write_time(made);
    play();
    EXPECT_EQ(fs::last_write_time(made), written) << "it is there already";
}

} // namespace
} // namespace q3rt::test
