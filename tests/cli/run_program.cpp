#include "run_program.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sys/wait.h>
#include <unistd.h>

namespace q3rt::test {

namespace {

namespace fs = std::filesystem;

/// Removes everything at exit.
struct ScratchRoot {
    fs::path path = fs::temp_directory_path() / ("q3rt-cli-test." + std::to_string(getpid()));
    ScratchRoot() { fs::create_directories(path); }
    ~ScratchRoot() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

const fs::path& scratchRoot() {
    static const ScratchRoot root;
    return root.path;
}

std::string quote(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text)
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::string readText(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

bool ProgramResult::saysInOneLine(const std::string& part) const {
    return std::count(errors.begin(), errors.end(), '\n') == 1 && errors.ends_with('\n') &&
           errors.find(part) != std::string::npos;
}

ProgramResult runQ3rt(const std::vector<std::string>& arguments, const std::vector<std::string>& environment) {
    const fs::path output = scratchRoot() / "stdout", errors = scratchRoot() / "stderr";
    // env takes its options before its assignments.
    std::string unset, set;
    for (const std::string& entry : environment)
        entry.ends_with('=') ? unset += " -u " + quote(entry.substr(0, entry.size() - 1)) : set += " " + quote(entry);
    std::string command = "env" + unset + set;
    command += " " + quote(std::string(Q3RT_BUILD_DIR) + "/q3rt");
    for (const std::string& argument : arguments)
        command += " " + quote(argument);
    command += " </dev/null >" + quote(output.string()) + " 2>" + quote(errors.string());
    const int status = std::system(command.c_str());
    ProgramResult result;
    // The shell reports a signal's end as 128 + its number.
    if (WIFEXITED(status) && WEXITSTATUS(status) < 128) result.exitCode = WEXITSTATUS(status);
    result.output = readText(output);
    result.errors = readText(errors);
    return result;
}

fs::path makeScratchFolder(const std::string& name) {
    const fs::path folder = scratchRoot() / name;
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

void writeFile(const fs::path& path, const std::vector<std::byte>& bytes) {
    fs::create_directories(path.parent_path());
    std::ofstream stream(path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

} // namespace q3rt::test
