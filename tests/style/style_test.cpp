// Limits with their exceptions. An exception names its file and says why; one that is no longer needed fails.

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "source_files.hpp"

namespace q3rt::test {

namespace {

constexpr size_t kCppLines = 500, kHeaderLines = 250, kShaderLines = 300, kFunctionLines = 60, kColumns = 120;

/// Path -> reason. Tables (*.def.h) are exempt by their name.
const std::map<std::string, std::string> kLongFiles = {};
/// "path: last line of the function's head" -> reason.
const std::map<std::string, std::string> kLongFunctions = {
    {"tests/formats/bsp_test.cpp: TEST(Bsp, DamageIsRefusedWithTheNameOfTheLump)", "a table, a line a kind of damage"},
};

size_t limitOf(const SourceFile& file) {
    if (file.path.ends_with(".def.h")) return SIZE_MAX;
    if (file.isShader()) return kShaderLines;
    return file.isHeader() ? kHeaderLines : kCppLines;
}

/// Width in characters, not bytes.
size_t columnsOf(const std::string& line) {
    return static_cast<size_t>(
        std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

const std::vector<SourceFile>& allFiles() {
    static const std::vector<SourceFile> files = loadSourceFiles();
    return files;
}

} // namespace

TEST(Style, FilesStayShort) {
    std::set<std::string> used;
    for (const SourceFile& file : allFiles()) {
        if (file.lines.size() <= limitOf(file)) continue;
        if (kLongFiles.contains(file.path)) {
            used.insert(file.path);
            continue;
        }
        ADD_FAILURE() << file.path << " has " << file.lines.size() << " lines, the limit is " << limitOf(file);
    }
    for (const auto& [path, reason] : kLongFiles)
        EXPECT_TRUE(used.contains(path)) << path << " needs no exception any more";
    EXPECT_GT(allFiles().size(), 50u);
}

TEST(Style, FunctionsStayShort) {
    std::set<std::string> used;
    size_t checked = 0;
    for (const SourceFile& file : allFiles()) {
        if (!file.isCpp() || file.path.ends_with(".def.h")) continue;
        for (const FunctionSize& function : measureFunctions(file)) {
            ++checked;
            if (function.lineCount <= kFunctionLines) continue;
            const std::string key = file.path + ": " + function.header;
            if (kLongFunctions.contains(key))
                used.insert(key);
            else
                ADD_FAILURE() << file.path << ":" << function.firstLine << " " << function.header << " has "
                              << function.lineCount << " lines, the limit is " << kFunctionLines;
        }
    }
    for (const auto& [key, reason] : kLongFunctions)
        EXPECT_TRUE(used.contains(key)) << key << " needs no exception any more";
    EXPECT_GT(checked, 300u);
}

TEST(Style, LinesStayNarrow) {
    for (const SourceFile& file : allFiles())
        for (size_t i = 0; i < file.lines.size(); ++i) {
            if (columnsOf(file.lines[i]) > kColumns && !file.path.ends_with(".def.h"))
                ADD_FAILURE() << file.path << ":" << i + 1 << " is wider than " << kColumns << " columns";
            if (file.lines[i].ends_with(' ') || file.lines[i].ends_with('\r'))
                ADD_FAILURE() << file.path << ":" << i + 1 << " ends in blank space";
        }
}

TEST(Style, NoPlaceOfOneMachineAndNoLeftovers) {
    // Written in pieces, so that this file doesn't find itself.
    const std::regex forbidden("(\"|\\s|=)/(wo"
                               "rk|ro"
                               "ot|ho"
                               "me)/|\\b(TO"
                               "DO|FIX"
                               "ME|XX"
                               "X|HA"
                               "CK)\\b");
    for (const SourceFile& file : allFiles())
        for (size_t i = 0; i < file.lines.size(); ++i)
            EXPECT_FALSE(std::regex_search(file.lines[i], forbidden))
                << file.path << ":" << i + 1 << " " << file.lines[i];
}

TEST(Style, HeadersAreGuarded) {
    for (const SourceFile& file : allFiles()) {
        if (!file.isHeader() || file.path.ends_with(".def.h")) continue;
        const bool guarded = std::any_of(file.lines.begin(), file.lines.end(), [](const std::string& line) {
            return line == "#pragma once" || line.starts_with("#ifndef ");
        });
        EXPECT_TRUE(guarded) << file.path;
    }
}

/// What the files of each folder of `root` may include of its folders. Returns the number of includes checked.
size_t checkDependencies(const std::string& root, const std::string& prefix,
                         const std::map<std::string, std::set<std::string>>& allowed) {
    const std::regex include("^#include \"" + prefix + "([a-z_0-9]+)/");
    size_t checked = 0;
    for (const SourceFile& file : allFiles()) {
        if (!file.path.starts_with(root)) continue;
        const std::string folder = file.path.substr(root.size(), file.path.find('/', root.size()) - root.size());
        const auto rule = allowed.find(folder);
        if (rule == allowed.end()) continue;
        for (const std::string& line : file.lines) {
            std::smatch match;
            if (!std::regex_search(line, match, include)) continue;
            ++checked;
            EXPECT_TRUE(rule->second.contains(match[1])) << file.path << " includes " << prefix << match[1] << "/";
        }
    }
    return checked;
}

TEST(Style, DependenciesPointOneWay) {
    const size_t checked = checkDependencies("code/", "",
                                             {
                                                 {"base", {"base"}},
                                                 {"math", {"base", "math"}},
                                                 {"formats", {"base", "math", "formats"}},
                                                 {"scene", {"base", "math", "accel", "formats", "scene", "shaders"}},
                                                 {"gpu", {"base", "gpu"}},
                                                 {"frame", {"base", "gpu", "frame"}},
                                                 {"relight", {"base", "math", "formats", "scene", "relight"}},
                                                 {"metrics", {"base", "metrics"}},
                                             });
    EXPECT_GT(checked, 100u);
    const size_t ofTheProgram = checkDependencies("code/host/", "host/",
                                                  {
                                                      {"headless", {"headless"}},
                                                      {"common", {"headless", "common"}},
                                                      {"packaged", {"headless", "common", "packaged"}},
                                                      {"still", {"headless", "common", "still"}},
                                                      {"inspect", {"common", "packaged", "still", "inspect"}},
                                                      {"trade", {"headless", "common", "still", "trade"}},
                                                  });
    EXPECT_GT(ofTheProgram, 100u);
}

TEST(Style, FunctionsAreMeasuredRightly) {
    SourceFile sample{"code/sample.cpp", {}};
    for (const char* line : {"namespace a {", "struct S {", "    int f() { return '{'; }", "    S() : m{1} {}", "};",
                             "constexpr int k[] = {", "1,", "};", "void g(", "    int x) {", "    if (x) { // {",
                             "    }", "    auto l = [&] { return \"}\"; };", "}", "}"})
        sample.lines.push_back(line);
    const std::vector<FunctionSize> functions = measureFunctions(sample);
    ASSERT_EQ(functions.size(), 4u); // the member initialiser counts as one of a line
    EXPECT_EQ(functions.front().lineCount, 1u);
    EXPECT_EQ(functions.back().lineCount, 5u);
    EXPECT_EQ(functions.back().firstLine, 10u);
}

} // namespace q3rt::test
