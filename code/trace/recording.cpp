#include "trace/recording.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <zlib.h>
#include <zstd.h>

#include "base/error.hpp"
#include "trace/field_archive.hpp"

namespace q3rt {
namespace {

/// A chunk is about a MiB, or one frame if that is longer. A frame with a full-size cinematic stays far below this.
constexpr uint64_t kMostRawBytes = uint64_t{1} << 30;

uint32_t checksum(const void* data, size_t bytes) {
    return static_cast<uint32_t>(crc32_z(0, static_cast<const Bytef*>(data), bytes));
}

std::unique_ptr<std::istream> openFile(const std::filesystem::path& path) {
    auto stream = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (!*stream)
        throw ContentError(formatText("%s: can't be read: %s; check the path, or make it with 'q3rt record'",
                                      path.c_str(), std::strerror(errno)));
    return stream;
}

} // namespace

Recording::Recording(const std::filesystem::path& path)
    : Recording(openFile(path), path.string()) {}

Recording::Recording(std::unique_ptr<std::istream> stream, std::string name)
    : m_stream(std::move(stream))
    , m_name(std::move(name)) {
    open();
}

void Recording::fail(const char* what) const {
    throw ContentError(
        formatText("%s: not a usable recording: %s; make it again with 'q3rt record'", m_name.c_str(), what));
}

void Recording::readBytes(uint64_t offset, void* data, size_t bytes) {
    if (offset > m_bytes || bytes > m_bytes - offset) fail("it is cut off");
    m_stream->seekg(static_cast<std::streamoff>(offset));
    m_stream->read(static_cast<char*>(data), static_cast<std::streamsize>(bytes));
    if (!*m_stream) fail("it can't be read");
}

void Recording::open() {
    if (!*m_stream) fail("it can't be opened");
    m_stream->seekg(0, std::ios::end);
    const auto end = m_stream->tellg();
    if (end < 0) fail("it can't be opened");
    m_bytes = static_cast<uint64_t>(end);
    TraceHeader header;
    TraceTrailer trailer;
    if (m_bytes < sizeof header + sizeof trailer) fail("it is too short");
    readBytes(0, &header, sizeof header);
    if (header.magic != kTraceMagic) fail("it does not begin as one");
    if (header.version != kTraceVersion)
        throw ContentError(formatText("%s: recording of version %u, this program reads version %u; record it again",
                                      m_name.c_str(), header.version, kTraceVersion));
    if (header.zero != 0) fail("its header is damaged");
    readBytes(m_bytes - sizeof trailer, &trailer, sizeof trailer);
    if (trailer.end != kTraceEnd || trailer.crc != checksum(&trailer.indexOffset, sizeof trailer.indexOffset))
        fail("its end is missing");
    readTables(trailer.indexOffset);
}

TraceChunkHeader Recording::readChunkHeader(uint64_t offset) {
    TraceChunkHeader header;
    readBytes(offset, &header, sizeof header);
    if (header.zero != 0) fail("a chunk's header is damaged");
    return header;
}

Recording::Chunk Recording::readChunk(uint64_t offset) {
    Chunk chunk;
    chunk.header = readChunkHeader(offset);
    const uint64_t dataOffset = offset + sizeof chunk.header;
    chunk.end = dataOffset + chunk.header.storedBytes;
    if (chunk.end > m_bytes) fail("it is cut off");
    std::vector<std::byte> stored(chunk.header.storedBytes);
    readBytes(dataOffset, stored.data(), stored.size());
    // The frame's own size must agree before it is believed: a small file must not ask for much memory.
    const auto declared = ZSTD_getFrameContentSize(stored.data(), stored.size());
    if (declared != chunk.header.rawBytes || declared > kMostRawBytes) fail("a chunk has a wrong size");
    chunk.raw.resize(chunk.header.rawBytes);
    const size_t bytes = ZSTD_decompress(chunk.raw.data(), chunk.raw.size(), stored.data(), stored.size());
    if (ZSTD_isError(bytes) || bytes != chunk.raw.size()) fail("a chunk can't be unpacked");
    if (checksum(chunk.raw.data(), chunk.raw.size()) != chunk.header.crc) fail("a checksum is wrong");
    return chunk;
}

void Recording::readTables(uint64_t indexOffset) {
    const Chunk index = readChunk(indexOffset);
    if (index.header.kind != TraceChunk::Index) fail("its index is missing");
    size_t at = 0;
    Decoder(index.raw, at, m_name)(m_index);
    // Files and Info stand between the events and the index: walk the chunks to them.
    bool infoFound = false;
    for (uint64_t offset = sizeof(TraceHeader); offset < indexOffset;) {
        const TraceChunkHeader header = readChunkHeader(offset);
        if (header.kind != TraceChunk::Events) {
            const Chunk chunk = readChunk(offset);
            size_t position = 0;
            Decoder decoder(chunk.raw, position, m_name);
            if (header.kind == TraceChunk::Files)
                while (position < chunk.raw.size())
                    m_files.emplace_back().fields(decoder);
            else if (header.kind == TraceChunk::Info) {
                m_info.fields(decoder);
                infoFound = true;
            } else
                fail("a chunk is of an unknown kind");
        }
        offset += sizeof header + header.storedBytes;
    }
    uint32_t worldFrames = 0;
    for (const TraceIndexEntry& entry : m_index)
        m_numbers.push_back(entry.isLoading ? -1 : static_cast<int>(m_info.firstFrame + worldFrames++));
    if (!infoFound || m_info.frameCount != worldFrames || m_info.firstFrame > kMostFrames)
        fail("its parts do not fit together");
}

Recording::Frame Recording::readFrame(size_t index) {
    const TraceIndexEntry& entry = m_index.at(index);
    if (entry.chunkOffset != m_cachedOffset) {
        Chunk chunk = readChunk(entry.chunkOffset);
        if (chunk.header.kind != TraceChunk::Events) fail("its index is wrong");
        m_cached = std::move(chunk.raw);
        m_cachedOffset = entry.chunkOffset;
    }
    if (entry.offset > m_cached.size() || entry.bytes > m_cached.size() - entry.offset) fail("its index is wrong");
    Frame frame;
    frame.isLoading = entry.isLoading != 0;
    frame.number = m_numbers[index];
    const size_t end = size_t{entry.offset} + entry.bytes;
    for (size_t offset = entry.offset; offset < end;)
        frame.events.push_back(decodeEvent(m_cached, offset, m_name));
    return frame;
}

} // namespace q3rt
