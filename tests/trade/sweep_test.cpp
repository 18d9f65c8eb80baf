// The program's smoke sweep, 10 points at 64x48 on a map of our own, and its going on after a cut; a recording's.

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "host/common/file_bytes.hpp"
#include "support/run_program.hpp"
#include "tiny_recording.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

std::string readText(const fs::path& path) {
    const std::vector<std::byte> bytes = readFileBytes(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Two views of a room at 64x48, and more arguments.
std::vector<std::string> roomArguments(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "trade",       "--map", "room_square_light", "--basepath", Q3RT_BUILD_DIR, "--game",
        "baseq3-test", "--at",  "spawn:0..1",        "--size",     "64x48"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

std::vector<std::string> sweepArguments(const fs::path& folder) {
    return roomArguments({"--smoke", "--warmup", "1", "--count", "3", "--reference-frames", "32", "--out",
                          (folder / "sweep.jsonl").string(), "--svg", (folder / "sweep.svg").string()});
}

size_t countLines(const std::string& text) { return static_cast<size_t>(std::count(text.begin(), text.end(), '\n')); }

} // namespace

TEST(TradeCommand, MeasuresTheSmokeSweepAndGoesOnAfterACut) {
    const fs::path folder = makeScratchFolder("sweep");
    const std::vector<std::string> environment = {"XDG_CACHE_HOME=" + (folder / "cache").string()};
    const ProgramResult first = runQ3rt(sweepArguments(folder), environment);
    if (first.errors.find("no Vulkan driver") != std::string::npos) GTEST_SKIP() << "no Vulkan device";
    ASSERT_EQ(first.exitCode, 0) << first.errors;
    EXPECT_NE(first.output.find("all lights"), std::string::npos) << first.output;
    EXPECT_NE(readText(folder / "sweep.svg").find("</svg>"), std::string::npos);
    const std::string lines = readText(folder / "sweep.jsonl");
    ASSERT_EQ(countLines(lines), 10u);
    for (size_t start = 0; start < lines.size(); start = lines.find('\n', start) + 1) {
        const auto json = nlohmann::json::parse(lines.substr(start, lines.find('\n', start) - start));
        EXPECT_GT(json["wall_ms"]["median"], 0.0);
        EXPECT_GT(json["ssim"]["value"], 0.5);
        EXPECT_LE(json["ssim"]["low"], json["ssim"]["high"]);
        EXPECT_EQ(json["views"].size(), 2u);
        EXPECT_EQ(json["frames"], 6);
        EXPECT_FALSE(json["passes"].empty());
        EXPECT_GT(json["rays"], 64 * 48) << "a ray to see and one to light each pixel, at least one";
        EXPECT_GT(json["memory_mib"], 0.0);
        EXPECT_NE(json["command"].get<std::string>().find("--smoke"), std::string::npos);
    }
    size_t references = 0;
    for (const auto& entry : fs::directory_iterator(folder / "cache/q3rt/references"))
        references += entry.path().extension() == ".png";
    EXPECT_EQ(references, 2u);

    // The last line half gone: one point is measured again, the others stay byte for byte.
    const size_t nineLines = lines.rfind('\n', lines.size() - 2) + 1;
    fs::resize_file(folder / "sweep.jsonl", nineLines + 100);
    const ProgramResult second = runQ3rt(sweepArguments(folder), environment);
    ASSERT_EQ(second.exitCode, 0) << second.errors;
    EXPECT_NE(second.errors.find("9 of 10 points are measured already"), std::string::npos) << second.errors;
    EXPECT_EQ(second.errors.find("reference frame"), std::string::npos) << "references come from the cache";
    const std::string again = readText(folder / "sweep.jsonl");
    EXPECT_EQ(countLines(again), 10u);
    EXPECT_EQ(again.substr(0, nineLines), lines.substr(0, nineLines));
}

// A point without time takes three frames a view; a reference that may be far from the truth is done early, is known
// again, and says of itself how far it is.
TEST(TradeCommand, TimeGoesWhereItMatters) {
    const fs::path folder = makeScratchFolder("budget");
    const auto run = [&](const std::string& out, const std::string& error) {
        return runQ3rt(roomArguments({"--axis", "rt_denoiser=0,1", "--set", "rt_taa=0", "--count", "50",
                                      "--seconds-per-point", "0.0001", "--reference-frames", "120", "--reference-error",
                                      error, "--out", (folder / out).string()}),
                       {"XDG_CACHE_HOME=" + (folder / "cache").string()});
    };
    const ProgramResult loose = run("loose.jsonl", "0.9");
    if (loose.errors.find("no Vulkan driver") != std::string::npos) GTEST_SKIP() << "no Vulkan device";
    ASSERT_EQ(loose.exitCode, 0) << loose.errors;
    EXPECT_NE(loose.errors.find("2 points: about"), std::string::npos) << loose.errors;
    EXPECT_NE(loose.output.find("references: means of up to 65 frames"), std::string::npos) << loose.output;
    const std::string lines = readText(folder / "loose.jsonl");
    const size_t second = lines.find('\n') + 1;
    for (const std::string& line : {lines.substr(0, second), lines.substr(second)}) {
        const auto json = nlohmann::json::parse(line);
        EXPECT_EQ(json["frames"], 6);
        EXPECT_EQ(json["reference"]["frames"], 65);
        EXPECT_GT(json["reference"]["error"], 0.0);
        EXPECT_LT(json["reference"]["error"], 0.9);
        EXPECT_GT(json["gpu_ms"]["median"], 0.0);
    }
    const ProgramResult strict = run("strict.jsonl", "0");
    ASSERT_EQ(strict.exitCode, 0) << strict.errors;
    EXPECT_NE(strict.output.find("means of up to 120 frames"), std::string::npos) << strict.output;
    fs::remove(folder / "loose.jsonl");
    const ProgramResult again = run("loose.jsonl", "0.9");
    EXPECT_EQ(again.errors.find("reference frame"), std::string::npos) << "references come from the cache";
    EXPECT_NE(again.output.find("means of up to 65 frames"), std::string::npos) << again.output;
}

// However few frames are timed, pictures are taken after the whole warm-up: the first view's are the same (those of the
// second one have other random numbers).
TEST(TradeCommand, FewTimesDontShortenTheWarmUp) {
    const fs::path folder = makeScratchFolder("warmup");
    const auto measure = [&](const std::string& count) {
        const fs::path out = folder / (count + ".jsonl");
        const ProgramResult result = runQ3rt(roomArguments({"--axis", "rt_denoiser=1", "--warmup", "16", "--count",
                                                            count, "--reference-frames", "8", "--out", out.string()}),
                                             {"XDG_CACHE_HOME=" + (folder / "cache").string()});
        if (result.errors.find("no Vulkan driver") != std::string::npos) return nlohmann::json();
        EXPECT_EQ(result.exitCode, 0) << result.errors;
        return nlohmann::json::parse(readText(out))["views"][0]["ssim"];
    };
    // Drawing the references takes random numbers too: they are there before what is compared.
    if (measure("2").is_null()) GTEST_SKIP() << "no Vulkan device";
    EXPECT_EQ(measure("1"), measure("24"));
}

TEST(TradeCommand, MeasuresChosenFramesOfARecording) {
    const fs::path folder = makeScratchFolder("recording");
    recordRoom(folder / "room.q3t", 12);
    const auto run = [&](const std::string& frames) {
        return runQ3rt({"trade",
                        (folder / "room.q3t").string(),
                        "--frames",
                        frames,
                        "--basepath",
                        Q3RT_BUILD_DIR,
                        "--game",
                        "baseq3-test",
                        "--axis",
                        "rt_denoiser=0,1",
                        "--size",
                        "64x48",
                        "--warmup",
                        "3",
                        "--count",
                        "2",
                        "--reference-frames",
                        "16",
                        "--out",
                        (folder / "sweep.jsonl").string()},
                       {"XDG_CACHE_HOME=" + (folder / "cache").string()});
    };
    ProgramResult result = run("1,9");
    if (result.errors.find("no Vulkan driver") != std::string::npos) GTEST_SKIP() << "no Vulkan device";
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    const std::string lines = readText(folder / "sweep.jsonl");
    ASSERT_EQ(countLines(lines), 2u);
    const auto json = nlohmann::json::parse(lines.substr(0, lines.find('\n')));
    EXPECT_EQ(json["views"][0]["view"], "frame:1");
    EXPECT_EQ(json["views"][1]["view"], "frame:9");
    EXPECT_GT(json["views"][0]["ssim"], 0.5);
    EXPECT_GT(json["views"][1]["ssim"], 0.5);
    result = run("12");
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("world frames 0 to 11")) << result.errors;
}

TEST(TradeCommand, BadArgumentsAreOneLine) {
    const std::string out = (makeScratchFolder("bad") / "x.jsonl").string();
    const std::vector<std::string> room = {"trade",      "--out",        out,      "--map",      "room_square_light",
                                           "--basepath", Q3RT_BUILD_DIR, "--game", "baseq3-test"};
    const auto run = [&](std::vector<std::string> more) {
        more.insert(more.begin(), room.begin(), room.end());
        return runQ3rt(more);
    };
    ProgramResult result = runQ3rt({"trade", "--out", out});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_TRUE(result.saysInOneLine("--map")) << result.errors;
    result = run({"--shard", "2/2"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_TRUE(result.saysInOneLine("2/2")) << result.errors;
    result = run({"--axis", "rt_taa"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_TRUE(result.saysInOneLine("CVAR=V1,V2")) << result.errors;
    result = run({"--at", "spawn:99"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("spawn points")) << result.errors;
    result = runQ3rt({"trade", "--out", out, "--map", "no_such_map"});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(result.saysInOneLine("no_such_map") || result.saysInOneLine("pk3")) << result.errors;
}

} // namespace q3rt::test
