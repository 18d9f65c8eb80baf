#include "host/packaged/engine_setup.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <unistd.h>

#include "base/error.hpp"
#include "formats/text_case.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/orphans.hpp"

namespace q3rt {
namespace {

namespace fs = std::filesystem;

constexpr int kOldProtocol = 70, kProtocol = 71;
/// What the engine accepts of its command line.
constexpr size_t kMostCommands = 32, kMostCharacters = 1024;
/// Maps that demos name but no package has, and the map with the same geometry that is there.
constexpr std::pair<const char*, const char*> kStandIns[] = {{"maps/q3dm6ish_v2.bsp", "maps/q3dm6ish.bsp"}};

void linkFile(const fs::path& target, const fs::path& link) {
    std::error_code ignored;
    fs::remove(link, ignored);
    std::error_code error;
    fs::create_symlink(target, link, error);
    if (error) throw UsageError(formatText("%s: can't be made: %s", link.c_str(), error.message().c_str()));
}

/// The game's archives beneath, the mission pack's game code on top: it is the version that recorded the old demos.
fs::path makeOldDemoOverlay(const Installation& installation, const fs::path& home) {
    const fs::path base = home / "overlay", game = base / installation.game;
    const fs::path missionPack = installation.dataBase / "missionpack" / "mp-pak0.pk3";
    const fs::path gameCode = installation.engineRenderers / "missionpack" / "cgamex86_64.so";
    for (const fs::path& needed : {missionPack, gameCode})
        if (!fs::exists(needed))
            throw ContentError(
                formatText("%s: needed for demos of protocol 70; install openarena-data and ioquake3", needed.c_str()));
    fs::create_directories(game / "maps");
    for (const fs::path& archive : installation.archives)
        linkFile(archive, game / archive.filename());
    linkFile(missionPack, game / "a-mp-pak0.pk3"); // sorts first: beneath everything
    linkFile(gameCode, game / "cgamex86_64.so");
    for (const char* library : {"uix86_64.so", "qagamex86_64.so"})
        linkFile(installation.libraryBase / installation.game / library, game / library);
    Pk3FileSource files({installation.dataBase}, {installation.game});
    for (const auto& [wanted, present] : kStandIns)
        if (const auto bytes = files.read(present)) writeFileBytes(game / wanted, *bytes);
    return base;
}

void appendSetting(std::string& script, const std::string& name, const std::string& value) {
    const auto bad = [](const std::string& text) { return text.find_first_of("\"\n\r;") != std::string::npos; };
    if (bad(name) || bad(value))
        throw UsageError(formatText("the engine can't take the setting %s=%s: no quotes, semicolons or line ends",
                                    name.c_str(), value.c_str()));
    script += "set " + name + " \"" + value + "\"\n";
}

/// Settings go into a script, because the command line is short.
void writeSettings(const EngineRun& run, const fs::path& gameHome) {
    std::string script;
    for (const auto& [name, value] : listSettings(run))
        appendSetting(script, name, value);
    writeFileBytes(gameHome / "autoexec.cfg", std::as_bytes(std::span(script)));
}

/// Recovered lights, installed ones and the user's own, where the engine looks.
void linkLights(const Installation& installation, const fs::path& gameHome) {
    for (const fs::path& folder : installation.lightFolders) {
        std::error_code error;
        if (fs::equivalent(folder, gameHome / "lights", error)) continue;
        for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
            const fs::path link = gameHome / "lights" / entry->path().filename();
            std::error_code ignored;
            if (entry->path().extension() != ".ent" || (fs::exists(link, ignored) && !fs::is_symlink(link, ignored)))
                continue;
            fs::create_directories(link.parent_path());
            linkFile(entry->path(), link);
        }
    }
}

std::string rendererName(const fs::path& module) {
    const std::string file = module.filename().string();
    constexpr std::string_view kPrefix = "renderer_", kSuffix = "_x86_64.so";
    if (!file.starts_with(kPrefix) || !file.ends_with(kSuffix))
        throw UsageError(formatText("%s: the engine loads only files named renderer_NAME_x86_64.so", module.c_str()));
    return file.substr(kPrefix.size(), file.size() - kPrefix.size() - kSuffix.size());
}

void addSets(std::vector<std::string>& arguments, std::initializer_list<std::pair<const char*, std::string>> sets) {
    for (const auto& [name, value] : sets)
        arguments.insert(arguments.end(), {"+set", name, value});
}

void checkLength(const std::vector<std::string>& arguments) {
    size_t commands = 0, characters = 0;
    for (size_t i = 1; i < arguments.size(); ++i) {
        commands += arguments[i].starts_with('+');
        characters += arguments[i].size() + 1;
    }
    if (commands > kMostCommands || characters >= kMostCharacters)
        throw UsageError("the engine's command line is limited to 32 commands and 1024 characters: use shorter paths");
}

void addGame(const EngineRun& run, const Installation& installation, const fs::path& home,
             std::vector<std::string>& arguments) {
    const bool oldDemo = run.demo.protocol == kOldProtocol;
    const fs::path base = oldDemo ? makeOldDemoOverlay(installation, home) : installation.libraryBase;
    addSets(arguments, {{"com_basegame", installation.game}, {"fs_basepath", base}, {"fs_homepath", home}});
    if (installation.game != "baseoa") return;
    addSets(arguments, {{"com_homepath", ".openarena"},
                        {"com_legacyprotocol", std::to_string(oldDemo ? kOldProtocol : kProtocol)},
                        {"com_protocol", std::to_string(kProtocol)}});
    // Turns a refused demo into an end of the program; OpenArena's own demo has harmless warnings, which it also ends.
    if (oldDemo) addSets(arguments, {{"com_buildScript", "1"}});
}

} // namespace

RunFolder::RunFolder(bool fresh)
    : m_fresh(fresh) {
    const fs::path cache = cacheFolder();
    if (!fresh) {
        m_path = cache / "home";
        fs::create_directories(m_path);
        return;
    }
    constexpr const char* kPrefix = "run-";
    std::error_code ignored;
    for (const fs::path& orphan : listOrphans(cache, kPrefix))
        fs::remove_all(orphan, ignored);
    std::string name = (cache / (nameOfProcess(kPrefix) + "-XXXXXX")).string();
    if (!mkdtemp(name.data()))
        throw UsageError(formatText("%s: can't be written to: %s; set XDG_CACHE_HOME to a writable folder",
                                    cache.c_str(), std::strerror(errno)));
    m_path = name;
}

RunFolder::~RunFolder() {
    std::error_code ignored;
    if (m_fresh) fs::remove_all(m_path, ignored);
}

CvarList listSettings(const EngineRun& run) {
    CvarList settings;
    if (run.size.width > 0)
        settings = {{"r_mode", "-1"},
                    {"r_customwidth", std::to_string(run.size.width)},
                    {"r_customheight", std::to_string(run.size.height)}};
    if (run.headless) settings.emplace_back("r_fullscreen", "0");
    settings.insert(settings.end(), run.cvars.begin(), run.cvars.end());
    return settings;
}

EngineCommand prepareEngine(const EngineRun& run, const fs::path& home) {
    const Installation installation = findInstallation(run.game);
    if (installation.engine.empty())
        throw UsageError(
            "the engine is missing: install the package ioquake3 ('q3rt doctor' lists all that is needed)");
    if (installation.libraryBase.empty())
        throw UsageError("the game's libraries are missing: install the package openarena");
    writeSettings(run, home / installation.game);
    linkLights(installation, home / installation.game);

    EngineCommand command;
    command.program = installation.engine;
    // The engine looks for modules in the folder that its own name claims.
    const fs::path moduleFolder = run.watched ? installation.programFolder : run.module.parent_path();
    std::vector<std::string>& arguments = command.arguments;
    arguments.push_back(moduleFolder / "ioquake3");
    addGame(run, installation, home, arguments);
    addSets(arguments, {{"cl_motd", "0"}, {"cl_renderer", run.watched ? "q3trecord" : rendererName(run.module)}});
    if (run.headless) addSets(arguments, {{"ttycon", "0"}, {"s_initsound", "0"}});
    if (run.timed) addSets(arguments, {{"timedemo", "1"}});
    if (!run.demo.name.empty()) {
        addSets(arguments, {{"nextdemo", "quit"}});
        arguments.insert(arguments.end(), {"+demo", run.demo.name});
    }
    if (!run.map.empty()) {
        addSets(arguments, {{"sv_pure", "0"}});
        arguments.insert(arguments.end(), {"+devmap", run.map});
    }
    checkLength(arguments);

    auto& environment = command.environment;
    if (run.headless) {
        environment.emplace_back("SDL_VIDEODRIVER", "dummy");
        environment.emplace_back("HOME", home);
        // What the driver and the renderers keep (compiled shaders, measured choices) stays where it is.
        environment.emplace_back("XDG_CACHE_HOME", fs::absolute(cacheFolder().parent_path()));
    }
    if (run.watched) environment.emplace_back(kRecordInner, run.module);
    if (!run.recordTo.empty()) {
        environment.emplace_back(kRecordOut, run.recordTo);
        environment.emplace_back(kRecordName, run.recordingName);
        environment.emplace_back(kRecordFirst, std::to_string(run.recordFirst));
        environment.emplace_back(kRecordCount, std::to_string(run.recordCount));
    }
    environment.emplace_back(kWatchEvery, std::to_string(run.pictureEvery));
    environment.emplace_back(kWatchStats, run.wantsStats ? "1" : "0");
    environment.emplace_back(kWatchCvars, run.cvars.empty() ? "0" : "1");
    environment.emplace_back(kWatchFrames, std::to_string(run.frameLimit));
    return command;
}

} // namespace q3rt
