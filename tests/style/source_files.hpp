#pragma once
// The repository's own text files, and just enough reading of C++ to measure functions.

#include <filesystem>
#include <string>
#include <vector>

namespace q3rt::test {

struct SourceFile {
    std::string path; ///< relative to the repository's root, forward slashes
    std::vector<std::string> lines;

    std::string extension() const { return std::filesystem::path(path).extension().string(); }
    bool isShader() const { return path.starts_with("shaders/") && extension() != ".h"; }
    bool isHeader() const { return extension() == ".hpp" || extension() == ".h"; }
    bool isCpp() const { return extension() == ".cpp" || isHeader(); }
};

/// All C++, GLSL, CMake and shell files.
std::vector<SourceFile> loadSourceFiles();

struct FunctionSize {
    std::string header; ///< last line before its brace
    size_t firstLine = 0, lineCount = 0;
};

/// Functions defined at namespace or class level, by matching braces outside comments and literals.
std::vector<FunctionSize> measureFunctions(const SourceFile& file);

} // namespace q3rt::test
