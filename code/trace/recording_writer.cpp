#include "trace/recording_writer.hpp"

#include <cerrno>
#include <cstring>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include "base/error.hpp"
#include "trace/field_archive.hpp"

namespace q3rt {
namespace {

/// Raw bytes of an event chunk: enough for zstd to find repetition between frames.
constexpr size_t kChunkBytes = size_t{1} << 20;
/// zstd's default: 3 is faster than the engine produces, higher levels gain under 10 % here.
constexpr int kCompression = 3;

} // namespace

RecordingWriter::RecordingWriter(std::filesystem::path path, std::string name)
    : m_path(std::move(path))
    , m_temporary(m_path.string() + formatText(".%d.tmp", static_cast<int>(getpid())))
    , m_name(std::move(name)) {
    std::error_code error; // opening says what is wrong
    if (std::filesystem::exists(m_path, error) && !std::filesystem::is_regular_file(m_path, error))
        fail("is no regular file"); // and must not be replaced by one
    m_file.reset(std::fopen(m_temporary.c_str(), "wb"));
    if (!m_file) fail(std::strerror(errno));
    const TraceHeader header;
    write(&header, sizeof header);
}

RecordingWriter::~RecordingWriter() {
    if (!m_file) return;
    m_file.reset();
    std::error_code ignored;
    std::filesystem::remove(m_temporary, ignored);
}

void RecordingWriter::fail(const char* what) const {
    throw UsageError(
        formatText("%s: can't be written: %s; choose a folder with space and write permission", m_name.c_str(), what));
}

void RecordingWriter::write(const void* data, size_t bytes) {
    if (std::fwrite(data, 1, bytes, m_file.get()) != bytes) fail(std::strerror(errno));
    m_offset += bytes;
}

void RecordingWriter::add(TraceEvent event) {
    m_frameEvents.emplace_back(m_events.size(), changesState(event));
    encodeEvent(event, m_events);
    noteEvent(event);
    if (std::holds_alternative<event::EndFrame>(event)) closeFrame();
}

void RecordingWriter::addFile(TraceFile file) { m_files.emplace(file.name, file); }

void RecordingWriter::noteEvent(const TraceEvent& event) {
    if (const auto* begin = std::get_if<event::BeginRegistration>(&event)) {
        m_info.width = begin->width;
        m_info.height = begin->height;
    } else if (const auto* world = std::get_if<event::LoadWorld>(&event)) {
        m_info.map = world->name;
    } else if (std::holds_alternative<event::EndRegistration>(event)) {
        m_worldReady = !m_info.map.empty();
    } else if (std::holds_alternative<event::Shutdown>(event)) {
        m_worldReady = false;
    }
}

void RecordingWriter::keepStretch(uint32_t first, uint32_t count) {
    m_first = m_info.firstFrame = first;
    m_count = count;
}

/// Takes the drawing events out of the open frame.
void RecordingWriter::dropDrawing() {
    size_t kept = m_frameStart;
    for (size_t i = 0; i < m_frameEvents.size(); ++i) {
        const auto [start, isKept] = m_frameEvents[i];
        const size_t end = i + 1 < m_frameEvents.size() ? m_frameEvents[i + 1].first : m_events.size();
        if (!isKept) continue;
        std::memmove(m_events.data() + kept, m_events.data() + start, end - start);
        kept += end - start;
    }
    m_events.resize(kept);
}

void RecordingWriter::closeFrame() {
    const bool isWorld = m_worldReady;
    const uint32_t number = m_worldFrames;
    m_worldFrames += isWorld;
    const bool isKept = number >= m_first && (m_count == 0 || number - m_first < m_count);
    if (isWorld && !isKept) dropDrawing();
    m_frameEvents.clear();
    if (m_events.size() == m_frameStart) return;
    TraceIndexEntry entry;
    entry.offset = static_cast<uint32_t>(m_frameStart);
    entry.bytes = static_cast<uint32_t>(m_events.size() - m_frameStart);
    entry.isLoading = !isWorld || !isKept;
    ++(entry.isLoading ? m_info.loadingFrameCount : m_info.frameCount);
    m_index.push_back(entry);
    m_frameStart = m_events.size();
    if (m_events.size() >= kChunkBytes) writeEvents();
}

void RecordingWriter::writeEvents() {
    if (m_firstPending == m_index.size()) return;
    // Events of an unfinished frame stay.
    const std::vector<std::byte> rest(m_events.begin() + static_cast<std::ptrdiff_t>(m_frameStart), m_events.end());
    m_events.resize(m_frameStart);
    const uint64_t offset = writeChunk(TraceChunk::Events, m_events);
    for (; m_firstPending < m_index.size(); ++m_firstPending)
        m_index[m_firstPending].chunkOffset = offset;
    for (auto& [start, isKept] : m_frameEvents)
        start -= m_frameStart;
    m_events = rest;
    m_frameStart = 0;
}

uint64_t RecordingWriter::writeChunk(TraceChunk kind, const std::vector<std::byte>& raw) {
    std::vector<std::byte> stored(ZSTD_compressBound(raw.size()));
    const size_t bytes = ZSTD_compress(stored.data(), stored.size(), raw.data(), raw.size(), kCompression);
    if (ZSTD_isError(bytes)) fail(ZSTD_getErrorName(bytes));
    TraceChunkHeader header;
    header.kind = kind;
    header.storedBytes = static_cast<uint32_t>(bytes);
    header.rawBytes = raw.size();
    header.crc = static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(raw.data()), raw.size()));
    const uint64_t offset = m_offset;
    write(&header, sizeof header);
    write(stored.data(), bytes);
    return offset;
}

void RecordingWriter::finish() {
    writeEvents();
    std::vector<std::byte> files, info, index;
    Encoder fileEncoder(files), infoEncoder(info), indexEncoder(index);
    for (auto& [name, file] : m_files)
        file.fields(fileEncoder);
    m_info.fields(infoEncoder);
    indexEncoder(m_index);
    writeChunk(TraceChunk::Files, files);
    writeChunk(TraceChunk::Info, info);
    TraceTrailer trailer;
    trailer.indexOffset = writeChunk(TraceChunk::Index, index);
    trailer.crc = static_cast<uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(&trailer.indexOffset), sizeof trailer.indexOffset));
    write(&trailer, sizeof trailer);
    if (std::fflush(m_file.get()) != 0) fail(std::strerror(errno));
    std::error_code error;
    std::filesystem::rename(m_temporary, m_path, error);
    if (error) fail(error.message().c_str());
    m_file.reset();
}

} // namespace q3rt
