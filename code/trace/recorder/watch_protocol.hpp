#pragma once
// What the interposer tells the program that started the engine, one message a frame, over the socket whose number is
// in the environment variable Q3RT_WATCH_FD: how long the frame took, the module's statistics, every N-th picture.

#include <cstdint>

namespace q3rt {

struct WatchMessage {
    static constexpr uint32_t kMagic = 0x77743371;
    static constexpr int32_t kStarted = -1; ///< the module registered: the text is its device
    /// Once, if kWatchCvars asks for it: the text has the name of each cvar, a line each, with kUndeclared before those
    /// that were set but that neither engine nor game nor renderer has declared.
    static constexpr int32_t kCvars = -2;
    static constexpr char kUndeclared = '?';

    uint32_t magic = kMagic;
    int32_t frame = 0;      ///< world frame, or one of the above
    double wallMs = 0;      ///< from BeginFrame to the end of EndFrame
    uint32_t textBytes = 0; ///< of the text that follows this message: statistics (a JSON object, or nothing)
    int32_t width = 0, height = 0;
    uint32_t pictureBytes = 0; ///< BGR rows, bottom first, padded to 4 bytes; they follow the text
};

/// How the line on the engine's console begins that says why a recording failed.
inline constexpr const char* kRecordingEnded = "recording ended: ";

/// Environment of the interposer. All but the socket may be absent.
inline constexpr const char* kWatchSocket = "Q3RT_WATCH_FD";
inline constexpr const char* kWatchEvery = "Q3RT_WATCH_EVERY";   ///< a picture every so many world frames
inline constexpr const char* kWatchStats = "Q3RT_WATCH_STATS";   ///< 1: the module is asked for its statistics
inline constexpr const char* kWatchCvars = "Q3RT_WATCH_CVARS";   ///< 1: cvars are listed once a world is drawn
inline constexpr const char* kWatchFrames = "Q3RT_WATCH_FRAMES"; ///< the engine is told to quit after so many
inline constexpr const char* kRecordInner = "Q3RT_RECORD_INNER"; ///< module to stand around
inline constexpr const char* kRecordOut = "Q3RT_RECORD_OUT";     ///< recording to write
inline constexpr const char* kRecordName = "Q3RT_RECORD_NAME";   ///< what messages call it, if not so
inline constexpr const char* kRecordFirst = "Q3RT_RECORD_FIRST"; ///< first world frame to keep
inline constexpr const char* kRecordCount = "Q3RT_RECORD_COUNT"; ///< number of world frames to keep

} // namespace q3rt
