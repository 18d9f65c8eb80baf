#pragma once
// Writes a recording. The file appears under its name only when finish() has written all of it; until then, and after
// any failure, there is at most a temporary file beside it, which the destructor removes.

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "trace/recording_format.hpp"
#include "trace/trace_event.hpp"

namespace q3rt {

class RecordingWriter {
  public:
    /// `name` is for messages: the file that the user asked for. Throws UsageError if the folder can't be written to.
    RecordingWriter(std::filesystem::path path, std::string name);
    explicit RecordingWriter(const std::filesystem::path& path)
        : RecordingWriter(path, path.string()) {}
    ~RecordingWriter();
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    /// Appends an event; EndFrame closes the frame. Throws UsageError when the disk is full.
    void add(TraceEvent event);
    void addFile(TraceFile file);
    void setRenderer(std::string name) { m_info.renderer = std::move(name); }
    /// Keeps world frames [first, first + count) whole; of others only what later frames build on. count 0: all.
    void keepStretch(uint32_t first, uint32_t count);
    /// World frames that came by, kept or not.
    uint32_t worldFramesSeen() const { return m_worldFrames; }
    /// Writes the rest and gives the file its name. Events after the last EndFrame are left out.
    void finish();
    const TraceInfo& info() const { return m_info; }

  private:
    struct CloseFile {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    void noteEvent(const TraceEvent& event);
    void closeFrame();
    void dropDrawing();
    void writeEvents();
    uint64_t writeChunk(TraceChunk kind, const std::vector<std::byte>& raw);
    void write(const void* data, size_t bytes);
    [[noreturn]] void fail(const char* what) const;

    std::filesystem::path m_path, m_temporary;
    std::string m_name;
    std::unique_ptr<std::FILE, CloseFile> m_file;
    uint64_t m_offset = 0; ///< bytes written
    std::vector<std::byte> m_events;
    size_t m_frameStart = 0; ///< in m_events
    /// Of each event of the open frame: where it starts, and whether later frames build on it.
    std::vector<std::pair<size_t, bool>> m_frameEvents;
    uint32_t m_first = 0, m_count = 0, m_worldFrames = 0;
    size_t m_firstPending = 0; ///< first index entry whose chunk isn't written yet
    std::vector<TraceIndexEntry> m_index;
    std::map<std::string, TraceFile> m_files;
    TraceInfo m_info;
    bool m_worldReady = false; ///< a map is loaded and registration has ended
};

} // namespace q3rt
