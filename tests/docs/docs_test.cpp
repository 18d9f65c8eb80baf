// Documentation says what is so: links lead somewhere, the settings page is current, marked commands run.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "settings_table.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = Q3RT_SOURCE_DIR;

std::vector<fs::path> listPages() {
    std::vector<fs::path> pages;
    if (fs::exists(kRoot / "README.md")) pages.push_back(kRoot / "README.md");
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / "docs"))
        if (entry.path().extension() == ".md") pages.push_back(entry.path());
    return pages;
}

std::string readText(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The fenced blocks whose opening line ends in "sh tested".
std::vector<std::string> findTestedBlocks(const std::string& page) {
    std::vector<std::string> blocks;
    const std::regex fence("(?:^|\n)```sh tested\n([^`]*)```");
    for (std::sregex_iterator block(page.begin(), page.end(), fence), end; block != end; ++block)
        blocks.push_back((*block)[1]);
    return blocks;
}

} // namespace

TEST(Docs, SettingsPageIsCurrent) {
    EXPECT_TRUE(readText(kRoot / "docs" / "settings.md") == renderSettingsPage())
        << "run build/print_settings_table > docs/settings.md";
}

TEST(Docs, LinksLeadToFiles) {
    const std::regex link("\\]\\(([^)#:]+)(#[^)]*)?\\)");
    size_t checked = 0;
    for (const fs::path& page : listPages()) {
        const std::string text = readText(page);
        for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found, ++checked)
            EXPECT_TRUE(fs::exists(page.parent_path() / (*found)[1].str())) << page << " links to " << (*found)[1];
    }
    EXPECT_GT(checked, 5u);
}

/// `Suite.Name` in a page is a test of this repository.
TEST(Docs, NamedTestsExist) {
    std::string tests;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / "tests"))
        if (entry.path().extension() == ".cpp") tests += readText(entry.path());
    const std::regex name("`([A-Z]\\w+)\\.([A-Z]\\w+)`");
    size_t checked = 0;
    for (const fs::path& page : listPages()) {
        const std::string text = readText(page);
        for (std::sregex_iterator found(text.begin(), text.end(), name), end; found != end; ++found, ++checked) {
            const std::string arguments = "(" + (*found)[1].str() + ", " + (*found)[2].str() + ")";
            EXPECT_NE(tests.find(arguments), std::string::npos) << page << " names " << (*found)[0];
        }
    }
    EXPECT_GT(checked, 20u);
}

TEST(Docs, MarkedCommandsRun) {
    if (!findGameFolder()) GTEST_SKIP() << kNoGameData;
    // A folder that looks like the repository's root after a build, so that nothing is written into the real one.
    const fs::path scratch = fs::temp_directory_path() / ("q3rt-docs-test." + std::to_string(getpid()));
    fs::create_directories(scratch);
    fs::create_directory_symlink(Q3RT_BUILD_DIR, scratch / "build");
    size_t run = 0;
    for (const fs::path& page : listPages())
        for (const std::string& block : findTestedBlocks(readText(page))) {
            std::ofstream(scratch / "block.sh") << block;
            const std::string command =
                "cd '" + scratch.string() + "' && bash -eu -o pipefail block.sh >log 2>&1 </dev/null";
            EXPECT_EQ(std::system(command.c_str()), 0) << page << "\n" << block << readText(scratch / "log");
            ++run;
        }
    fs::remove_all(scratch);
    EXPECT_GT(run, 0u);
}

} // namespace q3rt::test
