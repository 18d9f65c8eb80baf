#pragma once
// Where the engine, its game libraries and the game's data are on this machine. Looking never fails: what is absent is
// empty.

#include <filesystem>
#include <string>
#include <vector>

namespace q3rt {

struct GameChoice {
    std::string basePath; ///< folder that holds game folders; empty: Q3RT_GAME_DIR, else OpenArena's package
    std::string game;     ///< game folder such as baseoa or baseq3; empty: from Q3RT_GAME_DIR, else baseoa
};

struct Installation {
    std::filesystem::path engine;          ///< the packaged ioquake3
    std::filesystem::path engineRenderers; ///< folder of its own renderer modules
    std::filesystem::path libraryBase; ///< holds the game folder with native game libraries; the engine's fs_basepath
    std::filesystem::path dataBase;    ///< holds the game folder with pk3 archives
    std::string game;
    std::vector<std::filesystem::path> archives; ///< pk3 files of the game folder, by name
    std::filesystem::path programFolder;         ///< of the running program: our renderer modules stand beside it
    /// lights/ of the game as installed beside the program, then as the user made them in q3rt's home folder.
    std::vector<std::filesystem::path> lightFolders;
};

Installation findInstallation(const GameChoice& choice = {});

/// q3rt's folder for what can be made again. Throws UsageError if it can't be made.
std::filesystem::path cacheFolder();

} // namespace q3rt
