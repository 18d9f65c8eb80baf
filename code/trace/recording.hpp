#pragma once
// Reads a recording. Opening checks the container; events are decoded and checked as frames are read. Whatever is wrong
// is a ContentError that names the file.

#include <filesystem>
#include <istream>
#include <memory>

#include "trace/recording_format.hpp"
#include "trace/trace_event.hpp"

namespace q3rt {

class Recording {
  public:
    explicit Recording(const std::filesystem::path& path);
    /// From any seekable stream; `name` is for messages.
    Recording(std::unique_ptr<std::istream> stream, std::string name);

    const TraceInfo& info() const { return m_info; }
    const std::vector<TraceFile>& files() const { return m_files; }

    struct Frame {
        bool isLoading = false;
        int number = -1; ///< of world frames, from 0
        std::vector<TraceEvent> events;
    };
    /// All frames, loading ones included.
    size_t frameCount() const { return m_index.size(); }
    bool isLoading(size_t index) const { return m_index[index].isLoading != 0; }
    Frame readFrame(size_t index);

  private:
    struct Chunk {
        TraceChunkHeader header;
        std::vector<std::byte> raw;
        uint64_t end = 0; ///< offset of what follows in the file
    };
    void open();
    TraceChunkHeader readChunkHeader(uint64_t offset);
    Chunk readChunk(uint64_t offset);
    void readBytes(uint64_t offset, void* data, size_t bytes);
    void readTables(uint64_t indexOffset);
    [[noreturn]] void fail(const char* what) const;

    std::unique_ptr<std::istream> m_stream;
    std::string m_name;
    uint64_t m_bytes = 0; ///< file size
    std::vector<TraceIndexEntry> m_index;
    std::vector<int> m_numbers; ///< per index entry
    std::vector<TraceFile> m_files;
    TraceInfo m_info;
    uint64_t m_cachedOffset = 0; ///< of m_cached in the file; 0 none
    std::vector<std::byte> m_cached;
};

} // namespace q3rt
