#include "host/packaged/kept_configuration.hpp"

#include <map>
#include <optional>
#include <sstream>

#include "base/log.hpp"
#include "formats/text_case.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/orphans.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

constexpr const char* kConfiguration = "q3config.cfg"; ///< the engine's name for it
constexpr const char* kNote = "before-run-";           ///< and the number of the process that noted

/// Lines of a configuration by the cvar that they set, in lower case. A note says of an absent one that it is so.
using Lines = std::map<std::string, std::string>;
constexpr const char *kArchived = "seta", *kAbsent = "unset";

std::vector<std::string> readLines(const fs::path& file) {
    std::vector<std::string> lines;
    std::error_code error;
    if (!fs::exists(file, error)) return lines;
    const std::vector<std::byte> bytes = readFileBytes(file);
    std::istringstream text(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    for (std::string line; std::getline(text, line);)
        lines.push_back(line);
    return lines;
}

void writeLines(const fs::path& file, const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines)
        text += line + "\n";
    writeFileBytes(file, std::as_bytes(std::span(text)));
}

/// The cvar that a line is about, in lower case; nullopt for a line of another kind.
std::optional<std::string> cvarOf(const std::string& line) {
    std::istringstream words(line);
    std::string command, name;
    words >> command >> name;
    if ((command != kArchived && command != kAbsent) || name.empty()) return std::nullopt;
    return toLowerAscii(name);
}

/// Puts back what the note says and removes it.
void restore(const fs::path& folder, const fs::path& note) {
    Lines before;
    for (const std::string& line : readLines(note))
        if (const auto cvar = cvarOf(line)) before[*cvar] = line;
    std::vector<std::string> lines;
    const auto put = [&](const std::string& line) {
        if (line.starts_with(kArchived)) lines.push_back(line);
    };
    const std::vector<std::string> now = readLines(folder / kConfiguration);
    for (const std::string& line : now) {
        const auto noted = before.find(cvarOf(line).value_or(""));
        if (noted == before.end()) {
            lines.push_back(line);
            continue;
        }
        put(noted->second);
        before.erase(noted);
    }
    if (!now.empty()) {
        for (const auto& [cvar, line] : before)
            put(line);
        writeLines(folder / kConfiguration, lines);
    }
    fs::remove(note);
}

} // namespace

KeptConfiguration::KeptConfiguration(fs::path folder, const CvarList& settings)
    : m_folder(std::move(folder))
    , m_note(m_folder / (nameOfProcess(kNote) + ".cfg")) {
    for (const fs::path& orphan : listOrphans(m_folder, kNote))
        restore(m_folder, orphan);
    if (settings.empty()) return;
    Lines before;
    for (const auto& [name, value] : settings)
        before[toLowerAscii(name)] = std::string(kAbsent) + " " + name;
    for (const std::string& line : readLines(m_folder / kConfiguration))
        if (const auto noted = before.find(cvarOf(line).value_or("")); noted != before.end()) noted->second = line;
    std::vector<std::string> note;
    for (const auto& [cvar, line] : before)
        note.push_back(line);
    writeLines(m_note, note);
}

KeptConfiguration::~KeptConfiguration() {
    std::error_code error;
    if (!fs::exists(m_note, error)) return;
    try {
        restore(m_folder, m_note);
    } catch (const std::exception& failure) {
        logLine(LogLevel::Warning, "settings of this run stay in the configuration: %s", failure.what());
    }
}

} // namespace q3rt
