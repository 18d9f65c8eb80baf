#pragma once
// What the commands that run a renderer share: its module, the game's files, options and the summary of times.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "formats/pk3_file_source.hpp"
#include "host/common/installation.hpp"
#include "host/headless/headless_engine.hpp"
#include "trace/recording.hpp"

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace q3rt {

struct PictureSize {
    int width = 0, height = 0; ///< pixels; 0: not given
};
using CvarList = std::vector<std::pair<std::string, std::string>>;

/// Options that several commands take, with their meaning. Values are checked when they are parsed.
void addGameOptions(CLI::App& command, GameChoice& choice);
void addRendererOption(CLI::App& command, std::string& renderer);
/// A map's name, such as oa_dm1; its file's name is as good.
CLI::Option* addMapOption(CLI::App& command, std::string& map);
/// `usual` is what the help calls a size that is not given.
void addSizeOption(CLI::App& command, PictureSize& size, const char* usual = nullptr);
/// Of a cvar that is given twice the last value counts.
void addSetOption(CLI::App& command, CvarList& cvars, const char* name = "--set",
                  const char* meaning = "Set a cvar for this run; may be given several times");
/// From WIDTHxHEIGHT. Throws UsageError.
PictureSize parseSize(const std::string& text);

/// "rt", "vk", "null" ...: our module beside the program; a name with a slash or ".so": that file. Throws UsageError.
std::filesystem::path findModule(const std::string& renderer);
/// The game's archives. Throws ContentError if there are none, or if one is damaged.
std::unique_ptr<Pk3FileSource> openGame(const GameChoice& choice);
/// The file of the map of that name, such as oa_dm1. Throws ContentError if it isn't there or is damaged.
std::vector<std::byte> readMap(Pk3FileSource& files, const std::string& map);

/// The files that a recording names, wherever they are: in the game, in its mission pack, or under another name.
class RecordedFiles : public FileSource {
  public:
    /// Warns once if some files differ from those of the recording or are missing.
    RecordedFiles(const Recording& recording, const GameChoice& choice);
    std::optional<std::vector<std::byte>> read(std::string_view name) override;
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override;

  private:
    size_t countDifferences(Pk3FileSource& source, std::string& firstName) const;
    void findAliases();
    const Recording& m_recording;
    std::unique_ptr<Pk3FileSource> m_source;
    std::map<std::string, std::string> m_aliases; ///< recorded name -> name of the same bytes here
};

void writePng(const std::filesystem::path& path, const HostFrame& frame);

/// "1 frame", "2 frames".
std::string countOf(size_t count, const char* what);

/// Median and 99th percentile of milliseconds; nearest rank.
struct TimeSummary {
    double medianMs = 0, p99Ms = 0, totalMs = 0;
    size_t count = 0;
};
TimeSummary summarizeTimes(std::vector<double> ms);

/// One line of a statistics file: frame, wall_ms, and what the module said in its cvar q3rt_stats (a JSON object).
std::string statsLine(int frame, double wallMs, const std::string& moduleStats);

} // namespace q3rt
