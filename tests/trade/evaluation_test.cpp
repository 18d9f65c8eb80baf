// The evaluation: which points its figures need, well-formed charts, and one of it all at a tiny size.

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "host/common/file_bytes.hpp"
#include "host/trade/evaluation_figures.hpp"
#include "sample_results.hpp"
#include "support/run_program.hpp"
#include "svg_faults.hpp"
#include "tiny_recording.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

std::string readText(const fs::path& path) {
    const std::vector<std::byte> bytes = readFileBytes(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

size_t countLines(const std::string& text) { return static_cast<size_t>(std::count(text.begin(), text.end(), '\n')); }

TEST(Evaluation, SettingsAreTheThesis) {
    const std::vector<EvaluationSetting> timed = listTimedSettings(), sampled = listSampledSettings();
    EXPECT_EQ(timed.size(), 4u);
    EXPECT_EQ(sampled.size(), 13u);
    std::set<std::string> names;
    for (const EvaluationSetting& setting : sampled)
        names.insert(setting.name);
    EXPECT_EQ(names.size(), sampled.size()) << "names tell them apart";
    const TradePoint point = makePoint(sampled[5], {64, 48}, {{"rt_reflectionDepth", "2"}});
    EXPECT_EQ(point.frames, 2);
    EXPECT_EQ(point.cvars.at("rt_reflectionDepth"), "2");
    EXPECT_EQ(point.cvars.at("rt_antialiasing"), "1");
}

TEST(Evaluation, ChartsAreWellFormed) {
    TradeResult result = makeResult(12, 0.9);
    result.groups["denoise"] = {1, 0.9, 1.1, 1.2};
    const ResultOf resultOf = [&](const EvaluationSetting&, const PictureSize&) -> const TradeResult& {
        return result;
    };
    const std::vector<PictureSize> sizes = {{1280, 720}, {2560, 1440}};
    const FrameTrace trace{"all <lights>", 7, {1, 2, 30, 4}};
    for (const std::string& svg : {drawFrameTimes("a & b", sizes, resultOf), drawDenoiserTimes("x", sizes, resultOf),
                                   drawCulling("x", sizes, resultOf), drawSampleTimes("x", sizes[0], resultOf),
                                   drawSampleQuality("x", sizes[0], resultOf), drawFrameTrace("x", {trace})}) {
        EXPECT_EQ(findXmlFault(svg), "");
        EXPECT_NE(svg.find(" (") != std::string::npos || svg.find("in ms") != std::string::npos, false)
            << "axes say their unit";
    }
    EXPECT_NE(formatTraces({trace}).find("| 30.00 |"), std::string::npos);
    EXPECT_EQ(countLines(formatEvaluation(sizes, sizes[0], resultOf)), 2u + 2 + 2 + 1 + 2 + 13);
}

TEST(Evaluation, RunsAndGoesOn) {
    const fs::path folder = makeScratchFolder("evaluation");
    recordRoom(folder / "room.q3t", 12);
    const auto run = [&] {
        return runQ3rt({"trade",
                        (folder / "room.q3t").string(),
                        "--evaluation",
                        (folder / "out").string(),
                        "--map",
                        "room_square_light",
                        "--basepath",
                        Q3RT_BUILD_DIR,
                        "--game",
                        "baseq3-test",
                        "--sizes",
                        "32x18,48x27",
                        "--size",
                        "32x24",
                        "--warmup",
                        "2",
                        "--count",
                        "2",
                        "--pictures",
                        "2",
                        "--reference-frames",
                        "16"},
                       {"XDG_CACHE_HOME=" + (folder / "cache").string()});
    };
    const ProgramResult first = run();
    if (first.errors.find("no Vulkan driver") != std::string::npos) GTEST_SKIP() << "no Vulkan device";
    ASSERT_EQ(first.exitCode, 0) << first.errors;
    for (const char* figure : {"figure_7_07.svg", "figure_7_08.svg", "figure_7_09.svg", "figure_7_11_time.svg",
                               "figure_7_11_ssim.svg", "figure_7_13.svg"})
        EXPECT_EQ(findXmlFault(readText(folder / "out" / figure)), "") << figure;
    EXPECT_EQ(countLines(readText(folder / "out/evaluation.jsonl")), 2u * 4 + 13);
    EXPECT_EQ(countLines(readText(folder / "out/figure_7_13.jsonl")), 2u * 11) << "all but the first";
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out/figure_7_10"), fs::directory_iterator()), 13);
    EXPECT_EQ(first.output, readText(folder / "out/evaluation.md"));
    const ProgramResult second = run();
    EXPECT_EQ(second.exitCode, 0) << second.errors;
    EXPECT_EQ(countLines(readText(folder / "out/evaluation.jsonl")), 2u * 4 + 13) << "nothing is measured twice";
}

} // namespace
} // namespace q3rt::test
