#pragma once
// The engine's command line and folders. Split from engine_process.cpp, which starts and watches it.

#include <filesystem>
#include <string>
#include <vector>

#include "host/packaged/engine_process.hpp"

namespace q3rt {

/// A folder that disappears with its owner, unless it is kept.
class RunFolder {
  public:
    /// Headless: a fresh one. In a window: one that keeps the player's settings from game to game.
    explicit RunFolder(bool fresh);
    ~RunFolder();
    RunFolder(const RunFolder&) = delete;
    RunFolder& operator=(const RunFolder&) = delete;
    const std::filesystem::path& path() const { return m_path; }

  private:
    std::filesystem::path m_path;
    bool m_fresh;
};

struct EngineCommand {
    std::filesystem::path program;
    std::vector<std::string> arguments;                           ///< [0] lies in the folder of the modules
    std::vector<std::pair<std::string, std::string>> environment; ///< added to our own
};

/// What the run sets of the engine's cvars.
CvarList listSettings(const EngineRun& run);

/// Prepares `home` (start-up settings, and the overlay for older demos) and builds the command.
EngineCommand prepareEngine(const EngineRun& run, const std::filesystem::path& home);

} // namespace q3rt
