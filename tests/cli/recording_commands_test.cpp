// play, record, replay, view, subset from outside: exit codes, one error line, files.

#include <csignal>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"
#include "host/common/file_bytes.hpp"
#include "support/game_data.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

bool canPlay() {
    return findGameFolder() && fs::exists("/usr/lib/ioquake3/ioquake3") && fs::exists("/usr/lib/openarena");
}

TEST(RecordingCommands, BadArgumentsAreTwoAndOneLine) {
    const std::vector<std::vector<std::string>> cases = {
        {},
        {"nonsense"},
        {"replay"},
        {"replay", "a.q3t", "--size", "640"},
        {"replay", "a.q3t", "--size", "0x10"},
        {"replay", "a.q3t", "--size", "640x480x"},
        {"replay", "a.q3t", "--count", "0"},
        {"replay", "a.q3t", "--first", "-5"},
        {"replay", "a.q3t", "--set", "novalue"},
        {"record", "--demo", "x"},
        {"view", "--map", "x"},
        {"view", "--map", "x", "--out", "x.gif"},
        {"view", "--map", "x", "--out", "x.png", "--fov", "200"},
        {"subset", "--out", "x.pk3"},
        {"subset", "--map", "a", "--trace", "b", "--out", "x.pk3"},
        {"play", "--demo", "a", "--map", "b"},
    };
    for (const auto& arguments : cases) {
        const ProgramResult result = runQ3rt(arguments);
        std::string shown;
        for (const std::string& argument : arguments)
            shown += argument + " ";
        EXPECT_EQ(result.exitCode, 2) << shown;
        EXPECT_TRUE(result.saysInOneLine("q3rt: ")) << shown << result.errors;
    }
    RecordProperty("cases", static_cast<int>(cases.size()));
}

TEST(RecordingCommands, HelpIsComplete) {
    for (const char* command : {"play", "record", "replay", "view", "compare", "trade", "info", "doctor", "subset"}) {
        const ProgramResult result = runQ3rt({command, "--help"});
        EXPECT_EQ(result.exitCode, 0) << command;
        EXPECT_NE(result.output.find("--help"), std::string::npos) << command;
    }
}

TEST(RecordingCommands, MissingAndDamagedFilesFailWithTheirName) {
    const fs::path folder = makeScratchFolder("recording_commands");
    const fs::path damaged = folder / "damaged.q3t";
    std::ofstream(damaged) << "not a recording at all, but long enough to hold a header";
    EXPECT_EQ(runQ3rt({"replay", damaged.string()}).exitCode, 1);
    EXPECT_TRUE(runQ3rt({"replay", damaged.string()}).saysInOneLine("damaged.q3t"));
    EXPECT_TRUE(runQ3rt({"replay", (folder / "absent.q3t").string()}).saysInOneLine("absent.q3t"));
}

TEST(RecordingCommands, WhatIsMissingIsNamed) {
    if (!canPlay()) GTEST_SKIP() << kNoGameData;
    const fs::path folder = makeScratchFolder("missing_things");
    const std::string out = (folder / "a.q3t").string();
    EXPECT_TRUE(runQ3rt({"record", "--demo", "nosuch", "--out", out}).saysInOneLine("demo088-test1"));
    EXPECT_TRUE(
        runQ3rt({"record", "--demo", "demo088-test1", "--out", "/proc/nowhere/a.q3t"}).saysInOneLine("/proc/nowhere"));
    EXPECT_TRUE(runQ3rt({"view", "--map", "nosuch", "--renderer", "null", "--out", (folder / "a.png").string()})
                    .saysInOneLine("nosuch"));
    EXPECT_TRUE(
        runQ3rt({"view", "--map", "oa_dm1", "--at", "here", "--renderer", "null", "--out", (folder / "a.png").string()})
            .saysInOneLine("--at"));
    EXPECT_TRUE(runQ3rt({"view", "--map", "oa_dm1", "--at", "spawn:9999", "--renderer", "null", "--out",
                         (folder / "a.png").string()})
                    .saysInOneLine("spawn points"));
    EXPECT_TRUE(runQ3rt({"view", "--map", "oa_dm1", "--renderer", "nosuch", "--out", (folder / "a.png").string()})
                    .saysInOneLine("nosuch"));
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(RecordingCommands, AStretchOfTheDemoIsRecordedAndReplayed) {
    if (!canPlay()) GTEST_SKIP() << kNoGameData;
    const fs::path folder = makeScratchFolder("stretch");
    const std::vector<std::string> environment = {"XDG_CACHE_HOME=" + (folder / "cache").string()};
    const std::string recording = (folder / "a.q3t").string();
    const ProgramResult recorded =
        runQ3rt({"record", "--demo", "demo088-test1", "--first", "5", "--count", "10", "--out", recording, "--json"},
                environment);
    ASSERT_EQ(recorded.exitCode, 0) << recorded.errors;
    EXPECT_NE(recorded.output.find("\"frames\":10,\"first\":5"), std::string::npos) << recorded.output;
    EXPECT_TRUE(fs::is_empty(folder / "cache" / "q3rt")) << "the engine's private home was left behind";
    const fs::path pictures = folder / "pictures";
    const ProgramResult replayed = runQ3rt({"replay", recording, "--renderer", "null", "--size", "64x48", "--first",
                                            "7", "--count", "2", "--out", pictures.string(), "--json"});
    ASSERT_EQ(replayed.exitCode, 0) << replayed.errors;
    EXPECT_TRUE(fs::exists(pictures / "00000007.png") && fs::exists(pictures / "00000008.png"));
    EXPECT_NE(replayed.output.find("\"width\":64,\"height\":48"), std::string::npos);
    EXPECT_TRUE(runQ3rt({"replay", recording, "--renderer", "null", "--first", "0"}).saysInOneLine("5 to 14"));
    const ProgramResult subset = runQ3rt({"subset", "--trace", recording, "--out", (folder / "s.pk3").string()});
    EXPECT_EQ(subset.exitCode, 0) << subset.errors;
    EXPECT_GT(fs::file_size(folder / "s.pk3"), 1000000u);
}

/// Lights of kaos2 take their colours from images that nothing shows.
TEST(RecordingCommands, AMapsSubsetDrawsTheSamePicture) {
    if (!findGameFolder()) GTEST_SKIP() << kNoGameData;
    const fs::path folder = makeScratchFolder("map_subset");
    fs::create_directories(folder / "game/baseoa");
    const auto draw = [&](const char* name, std::vector<std::string> more) {
        std::vector<std::string> arguments = {"view",
                                              "--map",
                                              "kaos2",
                                              "--at",
                                              "spawn:0",
                                              "--size",
                                              "32x24",
                                              "--frames",
                                              "2",
                                              "--set",
                                              "rt_backend=compute",
                                              "--out",
                                              (folder / name).string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runQ3rt(arguments);
    };
    const ProgramResult whole = draw("whole.png", {});
    if (whole.errors.find("no Vulkan driver") != std::string::npos) GTEST_SKIP() << "no Vulkan device";
    ASSERT_EQ(whole.exitCode, 0) << whole.errors;
    ASSERT_EQ(runQ3rt({"subset", "--map", "kaos2", "--out", (folder / "game/baseoa/a.pk3").string()}).exitCode, 0);
    const ProgramResult part = draw("part.png", {"--basepath", (folder / "game").string(), "--game", "baseoa"});
    ASSERT_EQ(part.exitCode, 0) << part.errors;
    EXPECT_EQ(readFileBytes(folder / "whole.png"), readFileBytes(folder / "part.png"));
}

TEST(RecordingCommands, AFullDiskEndsTheRecordingInOneLine) {
    if (!canPlay()) GTEST_SKIP() << kNoGameData;
    const fs::path folder = makeScratchFolder("full_disk");
    // No file may grow beyond 40 KB: writes fail as on a full disk.
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit small{40 << 10, before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    const ProgramResult result =
        runQ3rt({"record", "--demo", "demo088-test1", "--out", (folder / "a.q3t").string(), "--count", "400"});
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, SIG_DFL);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("q3rt: " + (folder / "a.q3t").string() + ": can't be written")) << result.errors;
    EXPECT_TRUE(fs::is_empty(folder));
}

// A path is bytes; JSON is UTF-8.
TEST(RecordingCommands, JsonIsValidWhateverThePath) {
    const fs::path folder = makeScratchFolder("json_paths");
    makeBadInput(folder);
    const std::string odd = (folder / "caf\xe9 \xff").string();
    const std::vector<std::vector<std::string>> commands = {
        {"subset", "--map", kBadMap, "--basepath", (folder / "good").string(), "--out", odd + ".pk3"},
        {"doctor", "--out", odd}};
    for (std::vector<std::string> command : commands) {
        command.push_back("--json");
        const ProgramResult result = runQ3rt(command);
        EXPECT_TRUE(nlohmann::json::accept(result.output)) << result.output << result.errors;
        EXPECT_NE(result.output.find("caf\xef\xbf\xbd"), std::string::npos) << result.output;
    }
    if (!canPlay()) GTEST_SKIP() << kNoGameData;
    const ProgramResult recorded =
        runQ3rt({"record", "--demo", "demo088-test1", "--count", "1", "--out", odd + ".q3t", "--json"});
    EXPECT_EQ(recorded.exitCode, 0) << recorded.errors;
    EXPECT_TRUE(nlohmann::json::accept(recorded.output)) << recorded.output;
}

TEST(RecordingCommands, WhatAKilledRunLeftIsRemovedByTheNext) {
    if (!canPlay()) GTEST_SKIP() << kNoGameData;
    const fs::path cache = makeScratchFolder("orphans"), folder = makeScratchFolder("orphans_results");
    const std::vector<std::string> environment = {"XDG_CACHE_HOME=" + cache.string()};
    const ProgramResult killed =
        interruptQ3rt({"record", "--demo", "demo088-test1", "--out", (folder / "a.q3t").string()}, environment, SIGKILL,
                      [&] { return fs::exists(cache / "q3rt"); });
    EXPECT_EQ(killed.exitCode, -1);
    EXPECT_FALSE(fs::is_empty(cache / "q3rt"));
    const ProgramResult next = runQ3rt(
        {"record", "--demo", "demo088-test1", "--count", "1", "--out", (folder / "b.q3t").string()}, environment);
    EXPECT_EQ(next.exitCode, 0) << next.errors;
    EXPECT_TRUE(fs::is_empty(cache / "q3rt")) << fs::directory_iterator(cache / "q3rt")->path();
}

} // namespace
} // namespace q3rt::test
