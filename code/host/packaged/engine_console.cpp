#include "host/packaged/engine_console.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include "formats/text_case.hpp"
#include "host/common/file_bytes.hpp"
#include "host/headless/nearest_name.hpp"
#include "trace/recorder/watch_protocol.hpp"

namespace q3rt {
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
    std::vector<std::string> complaints;
    std::istringstream lines(console);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('^')) line.erase(0, 2); // the engine's colour of warnings
        const std::string name = line.substr(0, line.find_first_of(": "));
        const bool given = std::ranges::any_of(settings, [&](const auto& setting) { return setting.first == name; });
        if (given && std::ranges::find(complaints, line) == complaints.end()) complaints.push_back(line);
    }
    return complaints;
}

std::vector<std::string> listUndeclared(const std::string& cvars, const CvarList& settings) {
    std::vector<std::string> complaints, declared;
    std::set<std::string> undeclared; // in lower case
    std::istringstream lines(cvars);
    for (std::string name; std::getline(lines, name);) {
        if (name.starts_with(WatchMessage::kUndeclared))
            undeclared.insert(toLowerAscii(name.substr(1)));
        else
            declared.push_back(name);
    }
    for (const auto& [name, value] : settings)
        if (undeclared.contains(toLowerAscii(name)))
            complaints.push_back("--set " + name + "=" + value + ": no setting of engine, game or renderer is called " +
                                 name + hintAtNearest(name, declared));
    return complaints;
}

} // namespace q3rt
