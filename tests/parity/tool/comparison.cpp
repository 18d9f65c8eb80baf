#include "comparison.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.hpp"
#include "host/common/installation.hpp"

extern char** environ;

namespace q3rt::parity {

namespace {

namespace fs = std::filesystem;

/// Runs a program to its end; its exit status, or 128 + signal.
int runProgram(std::vector<std::string> words) {
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t process = 0;
    if (posix_spawnp(&process, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0)
        throw UsageError(words[0] + " can't be started: install it");
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool isDemo(const std::string& name) { return std::ranges::find(playableDemos(), name) != playableDemos().end(); }

fs::path recordingOf(const Comparison& comparison, const std::string& demo) {
    return comparison.folder / "recordings" / (demo + ".q3t");
}

void ensureRecording(const Comparison& comparison, const std::string& demo) {
    const fs::path file = recordingOf(comparison, demo);
    if (fs::exists(file)) return;
    fs::create_directories(file.parent_path());
    const fs::path q3rt = findInstallation().programFolder / "q3rt";
    if (runProgram({q3rt.string(), "record", "--demo", demo, "--out", file.string()}) != 0)
        throw ContentError(demo + " could not be recorded: see the message above");
}

/// An even share of all frames: 60 over 9 demos are 6 or 7 each.
int framesOf(const Comparison& comparison, const std::string& demo) {
    const std::vector<std::string>& all = comparison.demos.empty() ? playableDemos() : comparison.demos;
    const auto place = static_cast<int>(std::ranges::find(all, demo) - all.begin());
    const auto count = static_cast<int>(all.size());
    return comparison.demoFrames * (place + 1) / count - comparison.demoFrames * place / count;
}

PictureSource sourceOf(const Comparison& comparison, const std::string& name) {
    if (!isDemo(name)) return mapSource(*openGame(comparison.draw.game), name, comparison.camerasPerMap);
    ensureRecording(comparison, name);
    return demoSource(name, recordingOf(comparison, name), framesOf(comparison, name));
}

bool isDrawn(const PictureSource& source, const fs::path& folder) {
    const std::vector<std::string> names = source.pictureNames();
    return std::ranges::all_of(names, [&](const std::string& name) { return fs::exists(folder / (name + ".png")); });
}

/// Draws what is missing; judges what was drawn.
std::vector<Likeness> compareSource(const Comparison& comparison, const PictureSource& source,
                                    const std::vector<std::string>& command) {
    const fs::path folder = comparison.folder / source.name, known = folder / "likeness.txt";
    bool drawn = false;
    for (const std::string role : {"reference", "test"}) {
        if (isDrawn(source, folder / role) && !(comparison.again && role == "test")) continue;
        fs::remove_all(folder / role);
        fs::remove(known);
        drawn = true;
        std::vector<std::string> words = command;
        words.insert(words.end(), {"--draw", role, "--source", source.name});
        if (const int status = runProgram(words); status != 0)
            std::fprintf(stderr, "%s: the %s run ended with status %d\n", source.name.c_str(), role.c_str(), status);
    }
    std::vector<Likeness> result = readLikeness(known, source.name);
    if (result.size() == source.pictureNames().size()) return result;
    result = comparePictures(folder, source.name, source.pictureNames());
    if (!drawn || isDrawn(source, folder / "test")) writeLikeness(known, result);
    return result;
}

} // namespace

const std::vector<std::string>& playableDemos() {
    static const std::vector<std::string> demos = {"demo088-test1",  "flyby_compromise", "flyby_hydronex",
                                                   "flyby_oaspirit", "flyby_oa_dm3",     "flyby_suspended",
                                                   "stress_bases3",  "stress_sago",      "stress_q3dm6ishv2"};
    return demos;
}

void drawRole(const Comparison& comparison, const std::string& name, const std::string& role) {
    DrawSettings settings = comparison.draw;
    // The original then bakes gamma into its textures, as ours does: a display's ramp is in no picture.
    settings.cvars.insert(settings.cvars.begin(), {"r_ignorehwgamma", "1"});
    const std::string& module = role == "reference" ? comparison.reference : comparison.renderer;
    drawPictures(sourceOf(comparison, name), findModule(module), settings, comparison.folder / name / role);
}

std::vector<Likeness> compareAll(const Comparison& comparison, const std::string& program,
                                 const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {program};
    command.insert(command.end(), arguments.begin(), arguments.end());
    std::vector<std::string> names = comparison.maps;
    names.insert(names.end(), comparison.demos.begin(), comparison.demos.end());
    if (names.empty()) {
        names = listMaps(*openGame(comparison.draw.game));
        names.insert(names.end(), playableDemos().begin(), playableDemos().end());
    }
    std::vector<Likeness> all;
    for (const std::string& name : names) {
        const std::vector<Likeness> some = compareSource(comparison, sourceOf(comparison, name), command);
        all.insert(all.end(), some.begin(), some.end());
        std::string line = name + ":";
        for (const Likeness& likeness : some)
            line += formatText(" %.4f", likeness.ssim);
        std::printf("%s\n", line.c_str());
        std::fflush(stdout);
    }
    return all;
}

} // namespace q3rt::parity
