// A sweep's file: what is written is read again, what was cut off is measured again, foreign files stay as they are.

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "host/common/file_bytes.hpp"
#include "sample_results.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

std::string readText(const fs::path& path) {
    const std::vector<std::byte> bytes = readFileBytes(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void writeText(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

} // namespace

TEST(TradeResult, ALineHoldsWhatWasMeasured) {
    const TradeResult result = makeResult(12.5, 0.875, "4");
    const std::string line = toJsonLine(result);
    const auto json = nlohmann::json::parse(line);
    EXPECT_EQ(json["settings"]["rt_numRandomDL"], "4");
    EXPECT_EQ(json["settings"]["size"], "160x120");
    EXPECT_EQ(json["wall_ms"]["median"], 12.5);
    EXPECT_EQ(json["wall_ms"]["p99"], 25.0);
    EXPECT_EQ(json["ssim"]["value"], 0.875);
    EXPECT_NEAR(json["ssim"]["low"], 0.865, 1e-12);
    EXPECT_TRUE(json["psnr"]["value"].is_null()); // equal pictures
    EXPECT_TRUE(json["flip"]["low"].is_null());   // one value has no interval
    EXPECT_EQ(json["passes"]["direct"], 1.5);
    EXPECT_EQ(json["rays"], 1e6);
    const auto parsed = parseResult(line);
    ASSERT_TRUE(parsed);
    EXPECT_EQ(parsed->key, result.key);
    EXPECT_EQ(parsed->device, result.device);
    EXPECT_EQ(parsed->point, result.point);
    EXPECT_EQ(parsed->wallMs.q3, result.wallMs.q3);
    ASSERT_TRUE(parsed->gpuMs);
    EXPECT_EQ(parsed->gpuMs->q1, result.gpuMs->q1);
    EXPECT_EQ(parsed->times(TradeClock::Device).median, 6.25);
    EXPECT_EQ(parsed->times(TradeClock::Wall).median, 12.5);
    EXPECT_EQ(parsed->referenceFrames, 512);
    EXPECT_EQ(parsed->referenceError, 0.001);
    EXPECT_EQ(parsed->ssim.interval, result.ssim.interval);
    EXPECT_FALSE(parsed->flip.interval);
    EXPECT_TRUE(std::isinf(parsed->psnr.value));
    EXPECT_EQ(parsed->figures.at("rays"), 1e6);
}

TEST(TradeResult, WithoutTimersTheWallClockIsAllThereIs) {
    TradeResult result = makeResult(12.5, 0.875);
    result.gpuMs.reset();
    result.referenceError.reset();
    const auto parsed = parseResult(toJsonLine(result));
    ASSERT_TRUE(parsed);
    EXPECT_FALSE(parsed->gpuMs);
    EXPECT_FALSE(parsed->referenceError);
    EXPECT_EQ(parsed->times(TradeClock::Device).median, 12.5);
}

TEST(TradeResult, IntervalsWantTwoValues) {
    EXPECT_FALSE(estimateMean(std::vector{0.5}).interval);
    const TradeEstimate two = estimateMean(std::vector{0.4, 0.6});
    ASSERT_TRUE(two.interval);
    EXPECT_DOUBLE_EQ(two.value, 0.5);
    // Student's t for one degree of freedom, 12.706, times the standard error 0.1.
    EXPECT_NEAR(two.interval->second - two.value, 1.2706, 1e-4);
    EXPECT_FALSE(estimateMean(std::vector<double>{INFINITY, 30.0}).interval);
}

// Cuts the last of three lines at every byte: two results stay, the file ends after them and takes the third again.
TEST(TradeFile, ACutLineIsMeasuredAgain) {
    const fs::path path = makeScratchFolder("cut") / "sweep.jsonl";
    const std::vector<TradeResult> results = {makeResult(1, 0.5, "1"), makeResult(2, 0.75, "2"),
                                              makeResult(3, 0.9, "4")};
    std::string kept, last = toJsonLine(results[2]);
    for (size_t i = 0; i < 2; ++i)
        kept += toJsonLine(results[i]) + "\n";
    for (size_t length = 0; length <= last.size(); ++length) {
        writeText(path, kept + last.substr(0, length));
        TradeFile file(path);
        ASSERT_EQ(file.results().size(), 2u) << length;
        ASSERT_EQ(fs::file_size(path), kept.size()) << length;
        ASSERT_TRUE(file.find(results[1].key, results[1].device));
        ASSERT_FALSE(file.find(results[1].key, "another device"));
        ASSERT_FALSE(file.find(results[2].key, results[2].device));
        if (length % 100 != 0) continue;
        file.append(results[2]);
        ASSERT_EQ(readText(path), kept + last + "\n");
        ASSERT_TRUE(file.find(results[2].key, results[2].device));
    }
    EXPECT_EQ(TradeFile(path).results().size(), 2u);
}

TEST(TradeFile, ShardsMergeByConcatenation) {
    const fs::path folder = makeScratchFolder("merge");
    for (const char* part : {"a", "b"})
        TradeFile(folder / part).append(makeResult(1, 0.5, part));
    writeText(folder / "all", readText(folder / "a") + readText(folder / "b"));
    EXPECT_EQ(TradeFile(folder / "all").results().size(), 2u);
}

TEST(TradeFile, OtherPeoplesFilesStayAsTheyAre) {
    const fs::path path = makeScratchFolder("foreign") / "notes.txt";
    for (const std::string text : {"my notes", "my notes\n", "{\"key\":1}\n", "{\"other\":1}", "[1]\nmore\n"}) {
        writeText(path, text);
        EXPECT_THROW(TradeFile file(path), ContentError) << text;
        EXPECT_EQ(readText(path), text);
    }
}

TEST(TradeFile, HasOneWriterAtATime) {
    const fs::path path = makeScratchFolder("writers") / "sweep.jsonl";
    const TradeResult result = makeResult(1, 0.5, "1");
    {
        TradeFile file(path);
        EXPECT_THROW(TradeFile second(path), UsageError);
        EXPECT_TRUE(fs::exists(path)) << "the one refused took the file along";
        file.append(result);
        EXPECT_THROW(LineFile replaced(path), UsageError);
        EXPECT_EQ(readText(path), toJsonLine(result) + "\n");
    }
    EXPECT_TRUE(TradeFile(path).find(result.key, result.device)) << "a resumed sweep measures it again";
}

TEST(TradeFile, AFolderIsNoFile) { EXPECT_ANY_THROW(TradeFile file(makeScratchFolder("folder"))); }

} // namespace q3rt::test
