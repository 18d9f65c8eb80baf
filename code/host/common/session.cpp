#include "host/common/session.hpp"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/bsp.hpp"
#include "formats/image.hpp"
#include "formats/text_case.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/json_text.hpp"
#include "host/common/number_text.hpp"
#include "host/common/option_checks.hpp"
#include "host/common/setting_checks.hpp"
#include "host/headless/nearest_name.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMapFolder = "maps/", kMapSuffix = ".bsp";

/// The engine finds them in its home folder (engine_setup.cpp).
void addLights(Pk3FileSource& files, const Installation& installation) {
    for (const fs::path& folder : installation.lightFolders)
        files.addFolder(folder);
}

} // namespace

void addGameOptions(CLI::App& command, GameChoice& choice) {
    command.add_option("--basepath", choice.basePath,
                       "Folder that holds the game folder (default: OpenArena's package)");
    command.add_option("--game", choice.game, "Game folder, such as baseoa or baseq3 (default baseoa)");
}

void addRendererOption(CLI::App& command, std::string& renderer) {
    command
        .add_option("--renderer", renderer,
                    "rt (ray tracer), vk (rasteriser), null (no picture), or the path of any renderer module")
        ->capture_default_str();
}

CLI::Option* addMapOption(CLI::App& command, std::string& map) {
    const auto plainName = [](const std::string& text) {
        const size_t start = text.rfind(kMapFolder, 0) == 0 ? kMapFolder.size() : 0;
        const size_t end = text.rfind(kMapSuffix);
        const bool isFile = end != std::string::npos && end >= start && end + kMapSuffix.size() == text.size();
        return text.substr(start, isFile ? end - start : std::string::npos);
    };
    return command.add_option("--map", map, "Map name, such as oa_dm1")->transform(plainName);
}

void addSizeOption(CLI::App& command, PictureSize& size, const char* usual) {
    const std::string given = size.width > 0 ? formatText("%dx%d", size.width, size.height) : usual;
    command
        .add_option_function<std::string>(
            "--size", [&size](const std::string& text) { size = parseSize(text); },
            "Picture size in pixels (default: " + given + ")")
        ->type_name("WxH")
        ->check(checkedBy(parseSize));
}

PictureSize parseSize(const std::string& text) {
    constexpr int kLeast = 4, kMost = 16384; // pixels a side: of a window of the engine's, and of any device of ours
    const auto isSide = [](int pixels) { return pixels >= kLeast && pixels <= kMost; };
    if (const auto size = parsePair<int>(text, "x"); size && isSide(size->first) && isSide(size->second))
        return {size->first, size->second};
    throw UsageError(formatText("'%s' is no picture size: write WIDTHxHEIGHT, such as 640x480, from %d to %d pixels",
                                text.c_str(), kLeast, kMost));
}

void addSetOption(CLI::App& command, CvarList& cvars, const char* name, const char* meaning) {
    command
        .add_option_function<std::vector<std::string>>(
            name,
            [&cvars, name](const std::vector<std::string>& texts) {
                for (const std::string& text : texts) {
                    const size_t equals = text.find('=');
                    if (equals == 0 || equals == std::string::npos)
                        throw CLI::ValidationError(name, "'" + text + "' sets nothing: write CVAR=VALUE");
                    const std::string cvar = text.substr(0, equals), value = text.substr(equals + 1);
                    if (const std::string complaint = complainOfText(cvar, value); !complaint.empty())
                        throw CLI::ValidationError(text, complaint);
                    std::erase_if(cvars, [&](const auto& earlier) { return equalsIgnoringCase(earlier.first, cvar); });
                    cvars.emplace_back(cvar, value);
                }
            },
            meaning)
        ->type_name("CVAR=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

fs::path findModule(const std::string& renderer) {
    const bool isPath = renderer.find('/') != std::string::npos || renderer.ends_with(".so");
    const fs::path path =
        isPath ? fs::path(renderer) : findInstallation().programFolder / ("renderer_" + renderer + "_x86_64.so");
    if (!fs::exists(path))
        throw UsageError(formatText("%s: no such renderer module; use rt, vk, or the path of a module", path.c_str()));
    return fs::absolute(path);
}

std::unique_ptr<Pk3FileSource> openGame(const GameChoice& choice) {
    const Installation installation = findInstallation(choice);
    if (installation.archives.empty())
        throw ContentError(formatText("%s has no pk3 archives: install openarena-data, or name the folders with "
                                      "--basepath and --game",
                                      (installation.dataBase / installation.game).c_str()));
    auto files = std::make_unique<Pk3FileSource>(std::vector{installation.dataBase}, std::vector{installation.game});
    addLights(*files, installation);
    // The engine would go on without it, but what is drawn, counted or recorded here is to be complete.
    if (!files->damages().empty()) throw ContentError(files->damages().front());
    return files;
}

std::vector<std::byte> readMap(Pk3FileSource& files, const std::string& map) {
    const std::string name = std::string(kMapFolder) + map + std::string(kMapSuffix);
    auto bytes = files.readIntact(name);
    if (!bytes) {
        std::vector<std::string> maps = files.list("maps", kMapSuffix);
        for (std::string& file : maps)
            file.resize(file.size() - kMapSuffix.size());
        throw ContentError(name + " is not in the game's archives" + hintAtNearest(map, maps) +
                           ": choose another --map, or name the folders with --basepath and --game");
    }
    parseBsp(*bytes, name);
    return std::move(*bytes);
}

RecordedFiles::RecordedFiles(const Recording& recording, const GameChoice& choice)
    : m_recording(recording)
    , m_source(openGame(choice)) {
    std::string firstName;
    size_t differences = countDifferences(*m_source, firstName);
    const Installation installation = findInstallation(choice);
    if (differences > 0 && fs::exists(installation.dataBase / "missionpack")) {
        // Demos of the other game version were played with the mission pack beneath the game.
        auto extended = std::make_unique<Pk3FileSource>(std::vector{installation.dataBase},
                                                        std::vector<std::string>{"missionpack", installation.game});
        addLights(*extended, installation);
        std::string name;
        const size_t remaining = countDifferences(*extended, name);
        if (remaining < differences) {
            m_source = std::move(extended);
            differences = remaining;
            firstName = name;
        }
    }
    findAliases();
    differences -= std::min(differences, m_aliases.size());
    if (differences > 0)
        logLine(LogLevel::Warning,
                "%zu of %zu files of the recording are missing or other ones here, such as %s: the picture may differ",
                differences, recording.files().size(), firstName.c_str());
}

size_t RecordedFiles::countDifferences(Pk3FileSource& source, std::string& firstName) const {
    size_t count = 0;
    for (const TraceFile& file : m_recording.files()) {
        const auto origin = source.findOrigin(file.name);
        if (origin && origin->crc32 == file.crc && origin->size == file.bytes) continue;
        if (count++ == 0) firstName = file.name;
    }
    return count;
}

void RecordedFiles::findAliases() {
    std::map<std::pair<uint32_t, uint64_t>, std::string> namesByContent;
    for (const TraceFile& file : m_recording.files()) {
        if (m_source->findOrigin(file.name)) continue;
        if (namesByContent.empty())
            for (const Pk3* archive : m_source->archives())
                for (const Pk3Entry& entry : archive->entries())
                    namesByContent.try_emplace({entry.crc32, entry.size}, entry.name);
        const auto same = namesByContent.find({file.crc, file.bytes});
        if (same != namesByContent.end()) m_aliases[file.name] = same->second;
    }
}

std::optional<std::vector<std::byte>> RecordedFiles::read(std::string_view name) {
    if (auto file = m_source->read(name)) return file;
    const auto alias = m_aliases.find(toLowerAscii(name));
    return alias == m_aliases.end() ? std::nullopt : m_source->read(alias->second);
}

std::vector<std::string> RecordedFiles::list(std::string_view directory, std::string_view extension) {
    return m_source->list(directory, extension);
}

void writePng(const fs::path& path, const HostFrame& frame) {
    writeFileBytes(path, encodePng(frame.width, frame.height, 3, frame.rgb));
}

std::string countOf(size_t count, const char* what) {
    return formatText("%zu %s%s", count, what, count == 1 ? "" : "s");
}

TimeSummary summarizeTimes(std::vector<double> ms) {
    TimeSummary summary;
    summary.count = ms.size();
    if (ms.empty()) return summary;
    std::sort(ms.begin(), ms.end());
    for (const double value : ms)
        summary.totalMs += value;
    const auto rank = [&](double share) {
        const auto nearest = static_cast<size_t>(std::ceil(share * static_cast<double>(ms.size())));
        return ms[std::min(ms.size(), std::max<size_t>(nearest, 1)) - 1];
    };
    summary.medianMs = rank(0.5);
    summary.p99Ms = rank(0.99);
    return summary;
}

std::string statsLine(int frame, double wallMs, const std::string& moduleStats) {
    nlohmann::ordered_json line = {{"frame", frame}, {"wall_ms", wallMs}};
    const auto stats = nlohmann::ordered_json::parse(moduleStats, nullptr, false);
    if (stats.is_object())
        for (const auto& [name, value] : stats.items())
            line[name] = value;
    return toJsonText(line);
}

} // namespace q3rt
