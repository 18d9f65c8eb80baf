#pragma once
// Runs the packaged engine with one of our modules: its command line, its folders, its end. The player's own
// configuration is never written: the engine gets a home folder of its own in q3rt's cache.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "host/common/session.hpp"
#include "trace/recorder/watch_protocol.hpp"

namespace q3rt {

/// A demo in the game's archives.
struct DemoFile {
    std::string name;     ///< without folder and extension
    int protocol = 0;     ///< 71, or 70: made by an older game version, which needs its own game code
    size_t snapshots = 0; ///< about the number of frames of a timed run
};
/// Throws ContentError naming the demos that exist.
DemoFile findDemo(Pk3FileSource& files, const std::string& name);

struct EngineRun {
    GameChoice game;
    DemoFile demo;   ///< name empty: none
    std::string map; ///< empty: none
    std::filesystem::path module;
    bool headless = false, timed = false;
    PictureSize size;
    CvarList cvars;
    /// Through the interposer: reports frames and may record. Otherwise the engine loads the module itself.
    bool watched = false;
    bool wantsStats = false; ///< from the module; a software driver waits for the drawing where it is timed
    int pictureEvery = 0, frameLimit = 0; ///< 0: none
    std::filesystem::path recordTo;       ///< empty: no recording
    std::string recordingName;            ///< for messages: recordTo is only a place until it is complete
    int recordFirst = 0, recordCount = 0; ///< world frames; count 0: all
};

/// One message of the interposer about the renderer.
struct WatchedFrame {
    int frame = 0; ///< world frame, or WatchMessage::kStarted: then `text` is the device
    double wallMs = 0;
    std::string text;
    HostFrame picture; ///< width 0: none
};

/// Runs the engine to its end and hands over each frame. Throws with the engine's own last error if it fails, or if
/// nothing happens for a long time.
void runEngine(const EngineRun& run, const std::function<void(const WatchedFrame&)>& onFrame);

} // namespace q3rt
