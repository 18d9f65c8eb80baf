#pragma once
// pk3 archives (zip) and the search path made of them: what the engine's file system does, for the headless host.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace q3rt {

struct Pk3Entry {
    std::string name; ///< as in the archive
    uint32_t crc32 = 0;
    uint64_t size = 0;
};

/// One archive. Opening checks the directory; reading checks the entry's CRC. Throws ContentError.
class Pk3 {
  public:
    explicit Pk3(const std::filesystem::path& path);
    ~Pk3();
    Pk3(Pk3&&) noexcept;
    Pk3& operator=(Pk3&&) noexcept;
    const std::filesystem::path& path() const { return m_path; }
    const std::vector<Pk3Entry>& entries() const { return m_entries; }
    std::vector<std::byte> read(size_t entryIndex) const;

  private:
    struct Archive;
    std::filesystem::path m_path;
    std::vector<Pk3Entry> m_entries;
    std::unique_ptr<Archive> m_archive;
};

/// Writes a pk3; after an error what is there of it is the caller's to remove. Entries deflate-compressed, names kept.
void writePk3(const std::filesystem::path& path,
              const std::vector<std::pair<std::string, std::vector<std::byte>>>& entries);

} // namespace q3rt
