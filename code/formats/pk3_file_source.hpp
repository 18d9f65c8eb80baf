#pragma once
// The engine's search path over folders and pk3 archives, for programs that run without the engine.
// Highest priority first: the last game, in it the last base folder, in it loose files, then the archives from the last
// name to the first (names compared without regard to case). Not thread-safe.

#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/file_source.hpp"
#include "formats/pk3.hpp"

namespace q3rt {

class Pk3FileSource : public FileSource {
  public:
    /// Where a file comes from.
    struct Origin {
        std::filesystem::path container; ///< the archive, or the game folder of a loose file
        std::string name;                ///< as stored there
        uint32_t crc32 = 0;              ///< of the file's bytes
        uint64_t size = 0;               ///< bytes
        bool loose = false;
    };

    /// `baseFolders` such as /usr/share/games/openarena and `gameFolders` such as baseoa, lowest priority first.
    /// Folders that don't exist are passed over, and so are damaged archives: damages() names them.
    Pk3FileSource(const std::vector<std::filesystem::path>& baseFolders, const std::vector<std::string>& gameFolders);

    /// Files of a folder by its own name, "lights/a.ent" of /x/lights, before all that is there already.
    void addFolder(const std::filesystem::path& folder);

    std::optional<std::vector<std::byte>> read(std::string_view name) override;
    /// The same, but throws ContentError where read() would warn of a damaged copy and go on to the next one.
    std::optional<std::vector<std::byte>> readIntact(std::string_view name);
    /// Also names in folders up to two below `directory`, as the engine lists archives.
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override;

    /// The copy of `name` that read() returns, or nullopt. Reads a loose file for its checksum.
    std::optional<Origin> findOrigin(std::string_view name);
    /// What is wrong with each archive that was passed over, one line each.
    const std::vector<std::string>& damages() const { return m_damages; }
    /// All archives in use, highest priority first.
    std::vector<const Pk3*> archives() const;

  private:
    /// One folder or archive of the search path.
    struct Container {
        std::filesystem::path path;
        std::optional<Pk3> archive;                          ///< none: a folder of loose files
        std::vector<std::string> names;                      ///< in listing order, as stored
        std::unordered_map<std::string, size_t> indexOfName; ///< key lower case, forward slashes
    };

    void addGameFolder(const std::filesystem::path& folder);
    void addContainer(Container container);
    std::optional<std::vector<std::byte>> readFrom(const Container& container, size_t index) const;

    std::vector<Container> m_containers; ///< highest priority first
    std::vector<std::string> m_damages;
};

} // namespace q3rt
