#pragma once
// Runs build/q3rt as a user would.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace q3rt::test {

struct ProgramResult {
    int exitCode = -1; ///< -1: ended by a signal
    std::string output, errors;

    /// The error text is one line that holds `part`.
    bool saysInOneLine(const std::string& part) const;
};

/// `environment` entries are NAME=value; an empty value unsets.
ProgramResult runQ3rt(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {});

/// The same, with `signal` sent as soon as `isUnderWay` (or after a minute).
ProgramResult interruptQ3rt(const std::vector<std::string>& arguments, const std::vector<std::string>& environment,
                            int signal, const std::function<bool()>& isUnderWay);

/// A fresh empty folder of this process, removed at exit.
std::filesystem::path makeScratchFolder(const std::string& name);

std::vector<std::byte> readFile(const std::filesystem::path& path); ///< empty if there is none
void writeFile(const std::filesystem::path& path, const std::vector<std::byte>& bytes);

} // namespace q3rt::test
