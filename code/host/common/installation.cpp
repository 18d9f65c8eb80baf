#include "host/common/installation.hpp"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "base/error.hpp"
#include "base/user_cache.hpp"
#include "formats/text_case.hpp"

namespace q3rt {

namespace {

namespace fs = std::filesystem;

// Where Debian's packages ioquake3, openarena and openarena-data put them.
constexpr const char* kEngine = "/usr/lib/ioquake3/ioquake3";
constexpr const char* kLibraryBase = "/usr/lib/openarena";
constexpr const char* kDataBase = "/usr/share/games/openarena";
constexpr const char* kDefaultGame = "baseoa";

std::vector<fs::path> listArchives(const fs::path& folder) {
    std::vector<fs::path> archives;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (equalsIgnoringCase(entry->path().extension().string(), ".pk3")) archives.push_back(entry->path());
    std::sort(archives.begin(), archives.end());
    return archives;
}

fs::path ifExists(const fs::path& path) {
    std::error_code error;
    return fs::exists(path, error) ? path : fs::path();
}

void chooseData(const GameChoice& choice, Installation& found) {
    found.dataBase = kDataBase;
    found.game = choice.game.empty() ? kDefaultGame : choice.game;
    const char* named = std::getenv("Q3RT_GAME_DIR");
    if (!choice.basePath.empty()) {
        found.dataBase = choice.basePath;
    } else if (named != nullptr && *named != '\0') {
        // The folder with the archives, or the one above it.
        fs::path folder = fs::absolute(named).lexically_normal();
        if (!folder.has_filename()) folder = folder.parent_path();
        const bool holdsArchives = !listArchives(folder).empty();
        found.dataBase = holdsArchives ? folder.parent_path() : folder;
        if (holdsArchives && choice.game.empty()) found.game = folder.filename().string();
    }
    found.archives = listArchives(found.dataBase / found.game);
}

} // namespace

Installation findInstallation(const GameChoice& choice) {
    Installation found;
    found.engine = ifExists(kEngine);
    if (!found.engine.empty()) found.engineRenderers = found.engine.parent_path();
    chooseData(choice, found);
    // The user's own game brings its libraries along as bytecode in its archives.
    const bool isPackaged = found.dataBase == kDataBase;
    found.libraryBase = isPackaged ? ifExists(kLibraryBase) : found.dataBase;
    std::error_code error;
    found.programFolder = fs::read_symlink("/proc/self/exe", error).parent_path();
    found.lightFolders = {found.programFolder / found.game / "lights",
                          userCacheFolder() / "home" / found.game / "lights"};
    return found;
}

fs::path cacheFolder() {
    const fs::path folder = userCacheFolder();
    if (folder.empty()) throw UsageError("no place for temporary files: set HOME or XDG_CACHE_HOME");
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw UsageError(formatText("%s: can't be made: %s; set XDG_CACHE_HOME to a writable folder", folder.c_str(),
                                    error.message().c_str()));
    return folder;
}

} // namespace q3rt
