#include "host/packaged/engine_console.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>

#include "formats/text_case.hpp"
#include "host/common/file_bytes.hpp"
#include "host/headless/nearest_name.hpp"
#include "trace/recorder/watch_protocol.hpp"

namespace q3rt {
namespace {

/// A line of the engine's list of cvars: a column a flag, the name, the value in quotes.
struct ListedCvar {
    std::string name;
    bool isDeclared = false; ///< by engine, game or renderer; else it was only ever set
};

std::optional<ListedCvar> parseListed(const std::string& line) {
    constexpr size_t kLeastColumns = 8;
    const size_t value = line.find(" \"");
    if (value == std::string::npos || value <= kLeastColumns) return std::nullopt;
    const size_t gap = line.rfind(' ', value - 1);
    if (gap == std::string::npos || gap < kLeastColumns) return std::nullopt;
    const std::string flags = line.substr(0, gap);
    if (flags.find_first_not_of(" SsURIALCMV?") != std::string::npos) return std::nullopt;
    return ListedCvar{line.substr(gap + 1, value - gap - 1), flags.find('?') == std::string::npos};
}

} // namespace

std::string readConsole(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFileBytes(file);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string findLastError(const std::string& console) {
    constexpr std::string_view kCrash = "(Client fatal crashed: ", kCrashEnd = ") -----";
    if (const size_t crash = console.rfind(kCrash); crash != std::string::npos) {
        const size_t start = crash + kCrash.size();
        return console.substr(start, console.find(kCrashEnd, start) - start);
    }
    std::string found;
    std::istringstream lines(console);
    for (std::string line; std::getline(lines, line);)
        for (const char* part : {"ERROR: ", kRecordingEnded, "renderer_q3trecord: "})
            if (const size_t at = line.find(part); at != std::string::npos) found = line.substr(at);
    return found;
}

std::vector<std::string> listComplaints(const std::string& console, const CvarList& settings) {
    std::vector<std::string> complaints, declared;
    std::map<std::string, bool> isDeclared; // by lower-case name
    std::istringstream lines(console);
    for (std::string line; std::getline(lines, line);) {
        if (const auto cvar = parseListed(line)) {
            isDeclared[toLowerAscii(cvar->name)] = cvar->isDeclared;
            if (cvar->isDeclared) declared.push_back(cvar->name);
            continue;
        }
        if (line.starts_with('^')) line.erase(0, 2); // the engine's colour of warnings
        const std::string name = line.substr(0, line.find_first_of(": "));
        const bool given = std::ranges::any_of(settings, [&](const auto& setting) { return setting.first == name; });
        if (given && std::ranges::find(complaints, line) == complaints.end()) complaints.push_back(line);
    }
    for (const auto& [name, value] : settings)
        if (const auto listed = isDeclared.find(toLowerAscii(name)); listed != isDeclared.end() && !listed->second)
            complaints.push_back("--set " + name + "=" + value + ": no setting of engine, game or renderer is called " +
                                 name + hintAtNearest(name, declared));
    return complaints;
}

} // namespace q3rt
