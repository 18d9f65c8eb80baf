#include "host/inspect/doctor.hpp"

#include <algorithm>
#include <cstdlib>
#include <dlfcn.h>
#include <unistd.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/measured_choices.hpp"
#include "base/user_cache.hpp"
#include "gpu/capabilities.hpp"
#include "gpu/device.hpp"
#include "gpu/software_driver.hpp"
#include "host/common/output_file.hpp"
#include "host/common/progress.hpp"
#include "host/packaged/engine_process.hpp"
#include "scene/lost_light_file.hpp"
#include "scene/world.hpp"
#include "tracing_code.hpp"

namespace q3rt {

namespace {

namespace fs = std::filesystem;

Check checkEngine(const Installation& found) {
    if (found.engine.empty() || access(found.engine.c_str(), X_OK) != 0)
        return {"engine", Finding::Problem, "the packaged ioquake3 is missing", "apt-get install ioquake3"};
    return {"engine", Finding::Good, found.engine.string(), ""};
}

Check checkGameLibraries(const Installation& found) {
    if (found.libraryBase.empty())
        return {"game code", Finding::Problem, "OpenArena's game libraries are missing", "apt-get install openarena"};
    return {"game code", Finding::Good, (found.libraryBase / found.game).string(), ""};
}

/// Opens every archive; with `deep` reads every entry, which checks its sum.
void checkArchives(const Installation& found, bool deep, std::vector<Check>& checks) {
    const std::string folder = (found.dataBase / found.game).string();
    if (found.archives.empty()) {
        checks.push_back({"game data", Finding::Problem, "no pk3 archives in " + folder,
                          "apt-get install openarena-data openarena-088-data openarena-oacmp1, or name your own with "
                          "--basepath and --game"});
        return;
    }
    size_t files = 0, damaged = 0, done = 0;
    Progress progress("archive", deep ? found.archives.size() : 0);
    for (const fs::path& path : found.archives) {
        try {
            const Pk3 archive(path);
            files += archive.entries().size();
            for (size_t i = 0; deep && i < archive.entries().size(); ++i)
                archive.read(i);
            if (deep) progress.advance(++done);
        } catch (const ContentError& error) {
            ++damaged;
            checks.push_back({"game data", Finding::Problem, error.what(),
                              "apt-get install --reinstall openarena-data openarena-088-data openarena-oacmp1, or copy "
                              "the file again"});
        }
    }
    if (damaged == 0)
        checks.push_back({"game data", Finding::Good,
                          formatText("%zu archives with %zu files in %s%s", found.archives.size(), files,
                                     folder.c_str(), deep ? ", every file read and its sum right" : ""),
                          ""});
}

void checkDemo(Pk3FileSource& files, const DoctorOptions& options, std::vector<Check>& checks) {
    try {
        const DemoFile demo = findDemo(files, options.demo);
        checks.push_back({"demo", Finding::Good, demo.name + " is there", ""});
    } catch (const ContentError& error) {
        checks.push_back({"demo", options.demoNeeded ? Finding::Problem : Finding::Note, error.what(),
                          "name one of the game's own demos with --demo"});
    }
}

Check checkLight(Pk3FileSource& files, const World& world) {
    const std::string map = mapName(world);
    if (const auto found = findLostLights(files, world.bsp, map))
        return {"light", Finding::Good, found->file + " has the light that " + map + " lost", ""};
    return {"light", Finding::Note, "light that " + map + " lost is estimated while it loads",
            "q3rt relight --map " + map + " recovers it"};
}

void checkMap(Pk3FileSource& files, const std::string& map, std::vector<Check>& checks) {
    try {
        readMap(files, map);
        TextureLibrary textures(files, TextureSettings{});
        MaterialLibrary materials(files, textures, MaterialSettings{});
        const auto world = loadWorld(files, "maps/" + map + ".bsp", materials, WorldSettings{});
        checks.push_back({"map", Finding::Good, map + " loads", ""});
        checks.push_back(checkLight(files, *world));
    } catch (const ContentError& error) {
        checks.push_back({"map", Finding::Problem, error.what(), ""});
    }
}

void checkContent(const Installation& found, const DoctorOptions& options, std::vector<Check>& checks) {
    if (found.archives.empty()) return;
    Pk3FileSource files({found.dataBase}, {found.game});
    for (const fs::path& folder : found.lightFolders)
        files.addFolder(folder);
    if (!options.demo.empty()) checkDemo(files, options, checks);
    if (!options.map.empty()) checkMap(files, options.map, checks);
}

Check checkRecording(const std::string& path) {
    try {
        Recording recording{fs::path(path)};
        for (size_t i = 0; i < recording.frameCount(); ++i)
            recording.readFrame(i);
        const TraceInfo& info = recording.info();
        return {"recording", Finding::Good,
                formatText("%s: %u frames of %s", path.c_str(), info.frameCount, info.map.c_str()), ""};
    } catch (const ContentError& error) {
        return {"recording", Finding::Problem, error.what(), ""};
    }
}

void checkModules(const Installation& found, std::vector<Check>& checks) {
    for (const char* name : {"renderer_vk", "renderer_rt"}) {
        const fs::path module = found.programFolder / (std::string(name) + "_x86_64.so");
        void* library = dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
        checks.push_back({name, library ? Finding::Good : Finding::Problem, library ? module.string() : dlerror(),
                          library ? "" : "./run --set-up"});
        if (library) dlclose(library);
    }
}

/// The fetched software driver, and whether the Vulkan loader is told of it.
void checkFetchedDriver(std::vector<Check>& checks) {
    const char* variable = variableNamingDrivers();
    if (variable)
        checks.push_back({"drivers", Finding::Good, formatText("%s=%s", variable, std::getenv(variable)), ""});
    const fs::path fetched = findFetchedDriver();
    if (fetched.empty()) return;
    checks.push_back({"drivers", Finding::Good,
                      fetched.string() + (variable ? ": not added, the environment names drivers"
                                                   : ": fetched software driver, added to the machine's own"),
                      ""});
}

void checkDevices(std::vector<Check>& checks) {
    std::vector<Capabilities> devices;
    try {
        devices = listDevices();
    } catch (const DeviceError& error) {
        checks.push_back({"Vulkan", Finding::Problem, error.what(), ""});
        return;
    }
    bool anyUsable = false, anyTracing = false;
    for (const Capabilities& device : devices) {
        anyUsable = anyUsable || device.usable();
        anyTracing = anyTracing || (device.usable() && device.hardwareTracing());
        checks.push_back({"device", device.usable() ? Finding::Good : Finding::Note, describeCapabilities(device), ""});
    }
    if (!anyUsable)
        checks.push_back({"Vulkan", Finding::Problem, "no device here can run q3rt",
                          "a newer graphics driver, or ./run --set-up, which fetches a software driver"});
    else if (!anyTracing)
        checks.push_back({"ray tracing", Finding::Note, "no device here has Vulkan ray tracing",
                          "a newer graphics driver, or ./run --set-up, which fetches a software driver that has it"});
}

void checkChoices(std::vector<Check>& checks) {
    // Those of other builds are of no use to this one.
    for (const MeasuredChoice& choice : readMeasuredChoices(measuredChoicesFile()))
        if (choice.key.ends_with(kShaderHash))
            checks.push_back(
                {"measured", Finding::Good, choice.choice + " (" + choice.reason + ") for " + choice.key, ""});
}

Check checkDisplay() {
    const char* x11 = std::getenv("DISPLAY");
    const char* wayland = std::getenv("WAYLAND_DISPLAY");
    if ((x11 != nullptr && *x11 != '\0') || (wayland != nullptr && *wayland != '\0'))
        return {"display", Finding::Good, "a window can be opened", ""};
    return {"display", Finding::Note, "none: pictures go to files", "set DISPLAY or log in at a desktop for a window"};
}

Check checkOutputFolder(const std::string& folder) {
    try {
        const OutputFolder trial(folder);
        return {"output", Finding::Good, folder + " can be written", ""};
    } catch (const UsageError& error) {
        return {"output", Finding::Problem, error.what(), ""};
    }
}

/// Where the engine's home and what is kept from run to run go.
Check checkCache() {
    const fs::path folder = userCacheFolder();
    const char* remedy = "set XDG_CACHE_HOME to a writable folder";
    if (folder.empty())
        return {"cache", Finding::Problem, "no place for temporary files: neither HOME nor XDG_CACHE_HOME is set",
                remedy};
    try {
        const OutputFolder trial(folder);
        return {"cache", Finding::Good, folder.string() + " can be written", ""};
    } catch (const UsageError& error) {
        return {"cache", Finding::Problem, error.what(), remedy};
    }
}

Check checkReference(const Installation& found) {
    const bool module = !found.engineRenderers.empty() &&
                        access((found.engineRenderers / "renderer_opengl1_x86_64.so").c_str(), R_OK) == 0;
    const bool server = access("/usr/bin/Xvfb", X_OK) == 0;
    if (module && server) return {"reference", Finding::Good, "packaged opengl1 renderer and Xvfb", ""};
    return {"reference", Finding::Note, "the packaged opengl1 renderer can't be drawn as a reference",
            "apt-get install ioquake3 xvfb xauth"};
}

} // namespace

std::vector<Check> examineMachine(const DoctorOptions& options) {
    const Installation found = findInstallation(options.game);
    std::vector<Check> checks{checkEngine(found), checkGameLibraries(found)};
    checkArchives(found, options.deep, checks);
    checkContent(found, options, checks);
    checkModules(found, checks);
    checkFetchedDriver(checks);
    checkDevices(checks);
    checkChoices(checks);
    checks.push_back(checkCache());
    checks.push_back(checkDisplay());
    checks.push_back(checkReference(found));
    if (!options.recording.empty()) checks.push_back(checkRecording(options.recording));
    if (!options.outputFolder.empty()) checks.push_back(checkOutputFolder(options.outputFolder));
    return checks;
}

bool isPlayable(const std::vector<Check>& checks) {
    return std::none_of(checks.begin(), checks.end(),
                        [](const Check& check) { return check.finding == Finding::Problem; });
}

} // namespace q3rt
