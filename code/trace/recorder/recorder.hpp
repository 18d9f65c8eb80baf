#pragma once
// State of the recording interposer: the recorded module, the engine's imports, the file being written.
//
// The engine may longjmp over any frame of this module (see engine/guard.hpp), and the recorded module's frames lie
// between ours. So a function here forwards a call with nothing owning in its frame, and notes it before or after in
// note(), which returns before anything can jump. Calls are noted after they returned: what the module saw through its
// imports meanwhile then stands before the call in the file, where a replay needs it.

#include <exception>
#include <memory>
#include <unordered_map>
#include <vector>

#include "abi/ref_tables.h"
#include "trace/recording_writer.hpp"

namespace q3rt {

/// The module's handles to the recording's own numbers.
class HandleNumbers {
  public:
    /// The number of a handle that registration returned; 0 stays 0.
    int add(int handle);
    /// 0 for a handle that was never registered.
    int find(int handle) const;
    void clear() { m_numbers.clear(); }

  private:
    std::unordered_map<int, int> m_numbers;
};

struct Recorder {
    Recorder(const char* path, const char* name)
        : writer(path, name) {}

    RecordingWriter writer;
    HandleNumbers models, skins, shaders;
    struct SeenCvar {
        const cvar_t* cvar;
        int modificationCount;
    };
    std::unordered_map<std::string, SeenCvar> cvars;
    int uploadingCinematic = -1; ///< handle inside CIN_UploadCinematic
    int lastClockMs = -1;
    uint32_t lastFrame = 0; ///< world frames after which the engine is told to quit; 0: never

    void noteClock(int ms);
    void noteCvar(const cvar_t& cvar, const char* defaultValue);
    /// Cvars that changed since the last frame.
    void noteCvarChanges();
    void noteFile(const char* name, const void* bytes, long length);
};

/// Trivially destructible: the engine may unmap us, or end, at any moment.
struct RecorderModule {
    refimport_t engine;
    refexport_t inner;
    void* innerLibrary;
    Recorder* recorder; ///< null before the first registration, after the end, and after a failure
    bool inFrame;
    int frameClockMs; ///< what the module's clock shows from BeginFrame to EndFrame
};
extern RecorderModule recording;

/// Says why the recording ends here, and drops what was written.
void abandonRecording(const char* why);

/// Runs `function(recorder)`; a failure ends the recording, never the game.
template <class Function>
void note(Function&& function) {
    if (!recording.recorder) return;
    static char failure[1024];
    failure[0] = 0;
    try {
        function(*recording.recorder);
    } catch (const std::exception& error) {
        std::snprintf(failure, sizeof failure, "%s", error.what());
    }
    if (failure[0]) abandonRecording(failure);
}

refexport_t makeRecordingExports();
refimport_t makeRecordingImports(const refimport_t& engine);

} // namespace q3rt
