#pragma once
// The container of a recording (.q3t). All numbers little endian.
//
//   header   "q3rt-rec", u32 version, u32 0
//   chunks   u32 kind, u32 stored bytes, u64 raw bytes, u32 CRC-32 of the raw bytes, u32 0, then a zstd frame
//   trailer  u64 offset of the index chunk, u32 CRC-32 of that number, "q3rt"
//
// Headers need no checksum: every bit of theirs is either one fixed value (a reader refuses any other) or must agree
// with what it describes.
//
// Chunks: Events (whole frames, about a MiB), then one Files, one Info, one Index. The index lists every frame in
// order: where its bytes lie and whether it is a loading frame. Loading frames are those before the world is first
// drawn after a map load; the others are numbered from 0. A frame's bytes are trace events up to and including
// EndFrame; what came between two frames belongs to the second.

#include <array>
#include <cstdint>
#include <string>

namespace q3rt {

inline constexpr std::array<char, 8> kTraceMagic = {'q', '3', 'r', 't', '-', 'r', 'e', 'c'};
inline constexpr std::array<char, 4> kTraceEnd = {'q', '3', 'r', 't'};
inline constexpr uint32_t kTraceVersion = 1;
/// Of world frames: their numbers stay in an int.
inline constexpr uint32_t kMostFrames = 1u << 30;

enum class TraceChunk : uint32_t { Events = 1, Files = 2, Info = 3, Index = 4 };

struct TraceHeader {
    std::array<char, 8> magic = kTraceMagic;
    uint32_t version = kTraceVersion;
    uint32_t zero = 0;
};
struct TraceChunkHeader {
    TraceChunk kind = TraceChunk::Events;
    uint32_t storedBytes = 0;
    uint64_t rawBytes = 0;
    uint32_t crc = 0;
    uint32_t zero = 0;
};
struct TraceTrailer {
    uint64_t indexOffset = 0;
    uint32_t crc = 0; ///< of indexOffset
    std::array<char, 4> end = kTraceEnd;
};
/// One frame.
struct TraceIndexEntry {
    uint64_t chunkOffset = 0; ///< of the chunk header in the file
    uint32_t offset = 0;      ///< in the chunk's raw bytes
    uint32_t bytes = 0;
    uint32_t isLoading = 0;
    uint32_t zero = 0;
};
static_assert(sizeof(TraceHeader) == 16 && sizeof(TraceChunkHeader) == 24 && sizeof(TraceTrailer) == 16 &&
              sizeof(TraceIndexEntry) == 24);

/// A file that the recorded renderer read.
struct TraceFile {
    std::string name; ///< lower case
    uint32_t crc = 0; ///< CRC-32 of its bytes: what archives list
    uint64_t bytes = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(name);
        a(crc);
        a(bytes);
    }
};

/// About the whole recording.
struct TraceInfo {
    std::string map;      ///< of the last LoadWorld: "maps/x.bsp"
    std::string renderer; ///< glconfig's renderer string of the recorded module
    int32_t width = 0, height = 0;
    uint32_t firstFrame = 0; ///< number of the first world frame kept: a recording may be a stretch of a demo
    uint32_t frameCount = 0, loadingFrameCount = 0;
    template <class Archive>
    void fields(Archive& a) {
        a(map);
        a(renderer);
        a(width);
        a(height);
        a(firstFrame);
        a(frameCount);
        a(loadingFrameCount);
    }
};

} // namespace q3rt
