// Where results go: behind links, and to standard output, whatever that is.

#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bad_input.hpp"
#include "support/run_program.hpp"

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

class Output : public testing::Test {
  protected:
    static void SetUpTestSuite() { makeBadInput(s_in = makeScratchFolder("output")); }
    static ProgramResult subset(const std::string& out) {
        return runQ3rt({"subset", "--basepath", (s_in / "good").string(), "--map", kBadMap, "--out", out});
    }
    static inline fs::path s_in;
};

// It is a file here: a line a frame, then the summary.
TEST_F(Output, LinesAndSummaryShareStandardOutput) {
    const ProgramResult result =
        runQ3rt({"replay", "--basepath", (s_in / "good").string(), (s_in / "good.q3t").string(), "--renderer", "null",
                 "--stats", "/dev/stdout", "--json"});
    ASSERT_EQ(result.exitCode, 0) << result.errors;
    std::istringstream lines(result.output);
    std::vector<nlohmann::json> objects;
    for (std::string line; std::getline(lines, line);)
        objects.push_back(nlohmann::json::parse(line, nullptr, false));
    ASSERT_EQ(objects.size(), 5u) << result.output;
    for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(objects[i]["frame"], i) << result.output;
    EXPECT_EQ(objects[4]["frames"], 4) << result.output;
}

TEST_F(Output, FileAndSummaryShareStandardOutput) {
    const ProgramResult plain = subset((s_in / "a.pk3").string()), printed = subset("/dev/stdout");
    ASSERT_EQ(plain.exitCode, 0) << plain.errors;
    ASSERT_EQ(printed.exitCode, 0) << printed.errors;
    const std::vector<std::byte> file = readFile(s_in / "a.pk3");
    const std::string bytes(reinterpret_cast<const char*>(file.data()), file.size());
    EXPECT_EQ(printed.output.substr(0, bytes.size()), bytes);
    EXPECT_EQ(printed.output.substr(bytes.size()).find("/dev/stdout: "), 0u) << printed.output.substr(bytes.size());
    EXPECT_TRUE(fs::is_symlink("/dev/stdout"));
}

TEST_F(Output, ToADeviceLeavesTheDevice) {
    const ProgramResult none = subset("/dev/null"), full = subset("/dev/full");
    EXPECT_EQ(none.exitCode, 0) << none.errors;
    EXPECT_EQ(full.exitCode, 1);
    EXPECT_TRUE(full.saysInOneLine("q3rt: /dev/full: can't be written")) << full.errors;
    for (const char* device : {"/dev/null", "/dev/full"})
        EXPECT_TRUE(fs::is_character_file(device)) << device;
}

TEST_F(Output, BehindALinkTheLinkStays) {
    const fs::path link = s_in / "link.pk3", target = s_in / "far" / "target.pk3";
    writeFile(target, {});
    fs::create_symlink(target, link);
    ASSERT_EQ(subset(link.string()).exitCode, 0);
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_GT(fs::file_size(target), 100u);
    EXPECT_EQ(std::distance(fs::directory_iterator(s_in / "far"), fs::directory_iterator()), 1);
}

} // namespace
} // namespace q3rt::test
