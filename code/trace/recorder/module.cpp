// renderer_q3trecord: stands around the module that the environment names (watch_protocol.hpp), records what passes,
// and reports each frame to the program that started the engine. A vid_restart ends the recording: the file is complete
// up to there, and the game goes on unrecorded.

#include <cstdlib>
#include <dlfcn.h>

#include "trace/recorder/recorder.hpp"
#include "trace/recorder/watch.hpp"
#include "trace/recorder/watch_protocol.hpp"

namespace q3rt {
namespace {

/// Set in the process once a recording has begun: a module loaded again after vid_restart must not overwrite it.
constexpr const char* kStartedVariable = "Q3RT_RECORD_STARTED";

void refuse(const char* why, const char* detail) {
    recording.engine.Printf(Q3_PRINT_ERROR, "renderer_q3trecord: %s%s\n", why, detail);
}

bool loadInner(int apiVersion) {
    const char* path = std::getenv(kRecordInner);
    if (!path) {
        refuse("no module to record: set Q3RT_RECORD_INNER, or use 'q3rt record'", "");
        return false;
    }
    recording.innerLibrary = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const auto getRefApi =
        recording.innerLibrary ? reinterpret_cast<GetRefAPI_t>(dlsym(recording.innerLibrary, "GetRefAPI")) : nullptr;
    if (!getRefApi) {
        refuse("can't load the module to record: ", recording.innerLibrary ? path : dlerror());
        return false;
    }
    refimport_t imports = makeRecordingImports(recording.engine);
    const refexport_t* exports = getRefApi(apiVersion, &imports);
    if (exports) recording.inner = *exports;
    return exports != nullptr;
}

uint32_t numberFrom(const char* variable) {
    const char* text = std::getenv(variable);
    return text ? static_cast<uint32_t>(std::strtoul(text, nullptr, 10)) : 0;
}

void openFile() {
    const char* path = std::getenv(kRecordOut);
    if (!path) return; // only watched
    if (std::getenv(kStartedVariable)) return refuse("the recording ended with the restart: ", path);
    static char failure[1024];
    failure[0] = 0;
    try {
        const char* name = std::getenv(kRecordName);
        recording.recorder = new Recorder(path, name ? name : path);
        const uint32_t first = numberFrom(kRecordFirst), count = numberFrom(kRecordCount);
        recording.recorder->writer.keepStretch(first, count);
        recording.recorder->lastFrame = count > 0 ? first + count : 0;
    } catch (const std::exception& error) {
        std::snprintf(failure, sizeof failure, "%s", error.what());
    }
    if (failure[0]) return refuse("", failure);
    setenv(kStartedVariable, path, 1);
}

} // namespace
} // namespace q3rt

extern "C" [[gnu::visibility("default")]] refexport_t* GetRefAPI(int apiVersion, refimport_t* imports) {
    using namespace q3rt;
    static refexport_t exports;
    recording = {};
    recording.engine = *imports;
    if (apiVersion != REF_API_VERSION || !loadInner(apiVersion)) return nullptr;
    openFile();
    startWatching();
    exports = makeRecordingExports();
    return &exports;
}
