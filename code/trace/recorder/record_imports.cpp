// What the recorded module asks of the engine: passed on, and noted where a replay must give the same answer.

#include "trace/recorder/recorder.hpp"
#include "trace/recorder/watch.hpp"

namespace q3rt {
namespace {

int milliseconds() {
    // The clock stands still within a frame, so that a replay can show each call the same one.
    if (recording.inFrame) return recording.frameClockMs;
    const int ms = recording.engine.Milliseconds();
    note([ms](Recorder& recorder) { recorder.noteClock(ms); });
    return ms;
}

cvar_t* getCvar(const char* name, const char* value, int flags) {
    cvar_t* cvar = recording.engine.Cvar_Get(name, value, flags);
    if (cvar) note([=](Recorder& recorder) { recorder.noteCvar(*cvar, value); });
    return cvar;
}

long readFile(const char* name, void** buffer) {
    const long length = recording.engine.FS_ReadFile(name, buffer);
    if (buffer && *buffer && length >= 0) note([=](Recorder& recorder) { recorder.noteFile(name, *buffer, length); });
    return length;
}

int playCinematic(const char* name, int x, int y, int w, int h, int bits) {
    const int handle = recording.engine.CIN_PlayCinematic(name, x, y, w, h, bits);
    note([=](Recorder& recorder) { recorder.writer.add(event::CinematicPlay{name, handle}); });
    return handle;
}

int runCinematic(int handle) {
    const int status = recording.engine.CIN_RunCinematic(handle);
    note([=](Recorder& recorder) { recorder.writer.add(event::CinematicRun{handle, status}); });
    return status;
}

void uploadCinematic(int handle) {
    note([=](Recorder& recorder) { recorder.uploadingCinematic = handle; });
    recording.engine.CIN_UploadCinematic(handle);
    note([](Recorder& recorder) { recorder.uploadingCinematic = -1; });
}

void writeVideoFrame(const byte* bytes, int size) {
    if (!watchPicture(bytes, size)) recording.engine.CL_WriteAVIVideoFrame(bytes, size);
}

} // namespace

refimport_t makeRecordingImports(const refimport_t& engine) {
    refimport_t imports = engine;
    imports.Milliseconds = milliseconds;
    imports.Cvar_Get = getCvar;
    imports.FS_ReadFile = readFile;
    imports.CIN_PlayCinematic = playCinematic;
    imports.CIN_RunCinematic = runCinematic;
    imports.CIN_UploadCinematic = uploadCinematic;
    imports.CL_WriteAVIVideoFrame = writeVideoFrame;
    return imports;
}

} // namespace q3rt
