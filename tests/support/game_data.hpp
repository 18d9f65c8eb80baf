#pragma once
// Where tests find OpenArena's data. Q3RT_GAME_DIR names another game folder (the one that holds the pk3 files) or the
// folder above it.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "formats/pk3_file_source.hpp"

namespace q3rt::test {

struct GameFolder {
    std::filesystem::path base; ///< such as /usr/share/games/openarena
    std::string game;           ///< such as baseoa
};

/// The game folder, or nullopt where there is none.
std::optional<GameFolder> findGameFolder();

/// The engine's search path over it, or null where there is none.
std::unique_ptr<Pk3FileSource> openGameData();

/// Why a test that needs the data is skipped.
inline constexpr const char* kNoGameData =
    "needs OpenArena's data: install openarena-data, openarena-088-data and openarena-oacmp1, or set Q3RT_GAME_DIR";

} // namespace q3rt::test

/// First line of a test that needs the data: defines `files`, or skips.
#define Q3RT_OPEN_GAME_DATA_OR_SKIP(files)                                                                             \
    const auto files = q3rt::test::openGameData();                                                                     \
    if (!files) GTEST_SKIP() << q3rt::test::kNoGameData
