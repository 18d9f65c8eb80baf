#pragma once
// The files of recovered lights: where they lie, and making one.

#include <filesystem>
#include <optional>

#include "host/common/session.hpp"
#include "relight/light_truth.hpp"
#include "relight/relight.hpp"

namespace q3rt {

/// lights/ of the game in the home folder that `q3rt play` gives the engine.
std::filesystem::path lostLightFolder(const GameChoice& game);

struct RelightJob {
    std::string map;
    std::filesystem::path folder; ///< for MAP.ent
    RelightSettings settings;
};

struct RelightOutcome {
    std::filesystem::path file;
    RelightResult result;
    std::optional<TruthReport> truth; ///< of maps whose source is in the game's archives
    double wallSeconds = 0, processorSeconds = 0;
};

/// Is there a finished file for this map as it is, in the job's folder?
bool hasLostLights(Pk3FileSource& files, const RelightJob& job);
/// Makes the file in the user's folder if the game has none for this map as it is.
void ensureLostLights(Pk3FileSource& files, const GameChoice& game, const std::string& map);
/// Finds the lights and writes the file. What an earlier run of the same job left half done is gone on with.
RelightOutcome runRelight(Pk3FileSource& files, const RelightJob& job);

} // namespace q3rt
