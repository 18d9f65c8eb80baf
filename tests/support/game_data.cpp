#include "support/game_data.hpp"

#include <cstdlib>
#include <system_error>

namespace q3rt::test {
namespace {

namespace fs = std::filesystem;

bool hasArchives(const fs::path& folder) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (entry->path().extension() == ".pk3") return true;
    }
    return false;
}

} // namespace

std::optional<GameFolder> findGameFolder() {
    fs::path folder = "/usr/share/games/openarena/baseoa";
    if (const char* chosen = std::getenv("Q3RT_GAME_DIR")) {
        folder = fs::absolute(chosen).lexically_normal();
        if (!folder.has_filename()) folder = folder.parent_path();
        if (!hasArchives(folder) && hasArchives(folder / "baseoa")) folder /= "baseoa";
    }
    if (!hasArchives(folder)) return std::nullopt;
    return GameFolder{folder.parent_path(), folder.filename().string()};
}

std::unique_ptr<Pk3FileSource> openGameData() {
    const auto folder = findGameFolder();
    if (!folder) return nullptr;
    return std::make_unique<Pk3FileSource>(std::vector{folder->base}, std::vector{folder->game});
}

} // namespace q3rt::test
