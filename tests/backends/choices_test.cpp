// The file of measured choices: kept, replaced, damaged, out of reach.

#include <fstream>

#include <gtest/gtest.h>

#include "base/measured_choices.hpp"

namespace q3rt::test {
namespace {

TEST(MeasuredChoices, AreKeptReplacedAndForgottenWhenDamaged) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "q3rt choices test";
    const std::filesystem::path file = folder / "new" / "choices";
    std::filesystem::remove_all(folder);
    EXPECT_TRUE(readMeasuredChoices(file).empty());
    ASSERT_TRUE(keepMeasuredChoice(file, {"device A", "compute", "3 ms"}));
    ASSERT_TRUE(keepMeasuredChoice(file, {"device B", "query", "tab\tand\nline"}));
    ASSERT_TRUE(keepMeasuredChoice(file, {"device A", "pipeline", "2 ms"}));
    ASSERT_EQ(readMeasuredChoices(file).size(), 2u);
    EXPECT_EQ(findMeasuredChoice(file, "device A")->choice, "pipeline");
    EXPECT_EQ(findMeasuredChoice(file, "device B")->reason, "tab and line");
    EXPECT_FALSE(findMeasuredChoice(file, "device C"));
    const auto few = file.string() + ".few";
    for (int i = 0; i < 40; ++i)
        ASSERT_TRUE(keepMeasuredChoice(few, {"build " + std::to_string(i), "query", "1 ms"}));
    EXPECT_EQ(readMeasuredChoices(few).size(), 16u);
    EXPECT_TRUE(findMeasuredChoice(few, "build 39"));
    EXPECT_FALSE(findMeasuredChoice(few, "build 0"));
    // Cut at any byte before its last line it counts as absent.
    std::string text;
    std::getline(std::ifstream(file), text, '\0');
    int cuts = 0;
    for (size_t length = 0; length + 4 < text.size(); ++length, ++cuts) {
        std::ofstream(file, std::ios::trunc) << text.substr(0, length);
        EXPECT_TRUE(readMeasuredChoices(file).empty()) << length;
    }
    EXPECT_GT(cuts, 50);
    std::filesystem::remove_all(folder);
}

TEST(MeasuredChoices, NowhereToKeepThem) {
    EXPECT_FALSE(keepMeasuredChoice({}, {"device", "compute", "1 ms"}));
    EXPECT_FALSE(keepMeasuredChoice("/proc/q3rt/choices", {"device", "compute", "1 ms"}));
}

} // namespace
} // namespace q3rt::test
