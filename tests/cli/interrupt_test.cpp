// Ctrl-C in the middle of long work: nothing half-written stays, and no engine goes on by itself.

#include <algorithm>
#include <csignal>
#include <fstream>

#include <gtest/gtest.h>

#include "support/game_data.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> namesIn(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        names.push_back(entry->path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

/// Processes whose command line holds `text`.
int countProcesses(const std::string& text) {
    int count = 0;
    for (const std::string& name : namesIn("/proc")) {
        std::ifstream stream("/proc/" + name + "/cmdline", std::ios::binary);
        const std::string line{std::istreambuf_iterator<char>(stream), {}};
        count += line.find(text) != std::string::npos;
    }
    return count;
}

class Interrupt : public testing::Test {
  protected:
    void SetUp() override {
        if (!findGameFolder() || !fs::exists("/usr/lib/ioquake3/ioquake3")) GTEST_SKIP() << kNoGameData;
        m_folder = makeScratchFolder("interrupt");
        m_cache = makeScratchFolder("interrupt cache");
        m_environment = {"XDG_CACHE_HOME=" + m_cache.string()};
    }
    fs::path m_folder, m_cache;
    std::vector<std::string> m_environment;
};

TEST_F(Interrupt, ARecordingIsNotHalfWritten) {
    for (const int signal : {SIGINT, SIGTERM}) {
        // Under way: the interposer writes, beside the place that q3rt holds free.
        const auto isUnderWay = [&] { return namesIn(m_folder).size() >= 2; };
        const ProgramResult result =
            interruptQ3rt({"record", "--demo", "demo088-test1", "--out", (m_folder / "a.q3t").string()}, m_environment,
                          signal, isUnderWay);
        EXPECT_EQ(result.exitCode, 128 + signal) << result.errors;
        EXPECT_TRUE(namesIn(m_folder).empty()) << namesIn(m_folder).front();
        EXPECT_TRUE(namesIn(m_cache / "q3rt").empty()) << namesIn(m_cache / "q3rt").front();
        EXPECT_EQ(countProcesses(m_cache.string()), 0);
    }
}

TEST_F(Interrupt, AnOlderFileStays) {
    writeFile(m_folder / "a.q3t", std::vector<std::byte>(3));
    const auto isUnderWay = [&] { return namesIn(m_folder).size() >= 3; };
    const ProgramResult result =
        interruptQ3rt({"record", "--demo", "demo088-test1", "--out", (m_folder / "a.q3t").string()}, m_environment,
                      SIGINT, isUnderWay);
    EXPECT_EQ(result.exitCode, 128 + SIGINT);
    EXPECT_EQ(namesIn(m_folder), std::vector<std::string>{"a.q3t"});
    EXPECT_EQ(fs::file_size(m_folder / "a.q3t"), 3u);
}

TEST_F(Interrupt, AReplayLeavesWholePictures) {
    const std::string recording = (m_folder / "a.q3t").string();
    ASSERT_EQ(runQ3rt({"record", "--demo", "demo088-test1", "--count", "400", "--size", "64x48", "--out", recording},
                      m_environment)
                  .exitCode,
              0);
    const fs::path pictures = m_folder / "pictures";
    const ProgramResult result =
        interruptQ3rt({"replay", recording, "--renderer", "vk", "--size", "64x48", "--out", pictures.string()},
                      m_environment, SIGINT, [&] { return namesIn(pictures).size() > 3; });
    if (result.exitCode == 1) GTEST_SKIP() << result.errors; // no device
    EXPECT_EQ(result.exitCode, 128 + SIGINT);
    for (const std::string& name : namesIn(pictures))
        EXPECT_TRUE(name.ends_with(".png")) << name;
}

// Minutes of work between two lines of output.
TEST_F(Interrupt, LuxelsAreNotComparedToTheEnd) {
    const std::vector<std::string> info = {"info", "--map", "oa_dm1", "--luxels", "--points", "10000000"};
    int looks = 0;
    EXPECT_EQ(interruptQ3rt(info, m_environment, SIGINT, [&] { return ++looks > 100; }).exitCode, 128 + SIGINT);
}

} // namespace
} // namespace q3rt::test
