#pragma once
// Materials, textures and maps for scene tests, with or without OpenArena's data.

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/file_source.hpp"
#include "scene/world.hpp"

namespace q3rt::test {

/// Files by name, all in memory.
class MemoryFiles : public FileSource {
  public:
    std::unordered_map<std::string, std::vector<std::byte>> files;

    void addText(const std::string& name, std::string_view text);
    /// A uniform image of the given colour, as TGA.
    void addImage(const std::string& name, U8vec4 color);
    std::optional<std::vector<std::byte>> read(std::string_view name) override;
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override;
};

/// Another source whose images all are one small grey picture: what exists stays known, nothing big is decoded.
class TinyImageFiles : public FileSource {
  public:
    explicit TinyImageFiles(FileSource& source)
        : m_source(source) {}
    std::optional<std::vector<std::byte>> read(std::string_view name) override;
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override {
        return m_source.list(directory, extension);
    }

  private:
    FileSource& m_source;
};

/// Libraries over one source of files.
struct SceneLibraries {
    TextureLibrary textures;
    MaterialLibrary materials;
    explicit SceneLibraries(FileSource& files)
        : textures(files, TextureSettings{})
        , materials(files, textures, MaterialSettings{}) {}
};

/// One row of scene_census.csv.
using CensusRow = std::unordered_map<std::string, std::string>;
std::vector<CensusRow> readSceneCensus();
int censusNumber(const CensusRow& row, const std::string& column);

/// Collects log lines while it lives.
class LogCapture {
  public:
    LogCapture();
    ~LogCapture();
    size_t count(std::string_view part) const; ///< lines that contain it

  private:
    std::vector<std::string> m_lines;
};

} // namespace q3rt::test
