#include "base/measured_choices.hpp"

#include <fstream>
#include <sstream>
#include <unistd.h>

#include "base/log.hpp"
#include "base/user_cache.hpp"

namespace q3rt {

namespace {

constexpr std::string_view kFirstLine = "q3rt choices 1";
constexpr std::string_view kLastLine = "end";
constexpr ptrdiff_t kMostKept = 16;

/// Tabs and line ends part the fields.
std::string oneField(std::string text) {
    for (char& c : text)
        if (c == '\t' || c == '\n' || c == '\r') c = ' ';
    return text;
}

} // namespace

std::filesystem::path measuredChoicesFile() {
    const std::filesystem::path cache = userCacheFolder();
    return cache.empty() ? cache : cache / "choices";
}

std::vector<MeasuredChoice> readMeasuredChoices(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::string line;
    if (!stream || !std::getline(stream, line) || line != kFirstLine) return {};
    std::vector<MeasuredChoice> choices;
    while (std::getline(stream, line)) {
        if (line == kLastLine) return choices;
        std::istringstream fields(line);
        MeasuredChoice choice;
        if (!std::getline(fields, choice.key, '\t') || !std::getline(fields, choice.choice, '\t') ||
            !std::getline(fields, choice.reason))
            return {};
        choices.push_back(std::move(choice));
    }
    return {};
}

std::optional<MeasuredChoice> findMeasuredChoice(const std::filesystem::path& file, std::string_view key) {
    for (MeasuredChoice& choice : readMeasuredChoices(file))
        if (choice.key == key) return std::move(choice);
    return std::nullopt;
}

bool keepMeasuredChoice(const std::filesystem::path& file, const MeasuredChoice& choice) {
    if (file.empty()) return false;
    std::vector<MeasuredChoice> choices = readMeasuredChoices(file);
    std::erase_if(choices, [&](const MeasuredChoice& other) { return other.key == choice.key; });
    // Other builds of the program measure for themselves; what is oldest is asked for least.
    if (std::ssize(choices) >= kMostKept) choices.erase(choices.begin(), choices.end() - (kMostKept - 1));
    choices.push_back({oneField(choice.key), oneField(choice.choice), oneField(choice.reason)});
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    // Its own name for each process: two that measure at once don't write into one file.
    const std::filesystem::path fresh = file.string() + "." + std::to_string(getpid());
    std::ofstream stream(fresh);
    stream << kFirstLine << '\n';
    for (const MeasuredChoice& each : choices)
        stream << each.key << '\t' << each.choice << '\t' << each.reason << '\n';
    stream << kLastLine << '\n';
    stream.close();
    const bool written = stream.good();
    if (written) std::filesystem::rename(fresh, file, error);
    if (written && !error) return true;
    std::filesystem::remove(fresh, error);
    logLine(LogLevel::Warning, "%s: can't be written; what was measured is measured again next time", file.c_str());
    return false;
}

} // namespace q3rt
