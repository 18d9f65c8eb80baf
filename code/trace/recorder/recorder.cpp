#include "trace/recorder/recorder.hpp"

#include <cstdlib>
#include <zlib.h>

#include "trace/recorder/watch_protocol.hpp"

namespace q3rt {

RecorderModule recording;

int HandleNumbers::add(int handle) {
    if (handle == 0) return 0;
    return m_numbers.try_emplace(handle, static_cast<int>(m_numbers.size()) + 1).first->second;
}

int HandleNumbers::find(int handle) const {
    const auto found = m_numbers.find(handle);
    return found == m_numbers.end() ? 0 : found->second;
}

void Recorder::noteClock(int ms) {
    if (ms == lastClockMs) return;
    lastClockMs = ms;
    writer.add(event::Clock{ms});
}

void Recorder::noteCvar(const cvar_t& cvar, const char* defaultValue) {
    const auto [seen, isNew] = cvars.try_emplace(cvar.name, SeenCvar{&cvar, cvar.modificationCount});
    if (!isNew && seen->second.modificationCount == cvar.modificationCount) return;
    seen->second.modificationCount = cvar.modificationCount;
    const bool isDefault = defaultValue && std::string_view(defaultValue) == cvar.string;
    writer.add(event::CvarValue{cvar.name, cvar.string, isDefault});
}

void Recorder::noteCvarChanges() {
    for (auto& [name, seen] : cvars) {
        if (seen.modificationCount == seen.cvar->modificationCount) continue;
        seen.modificationCount = seen.cvar->modificationCount;
        writer.add(event::CvarValue{name, seen.cvar->string, false});
    }
}

void Recorder::noteFile(const char* name, const void* bytes, long length) {
    TraceFile file;
    file.name = name;
    for (char& c : file.name)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    file.bytes = static_cast<uint64_t>(length);
    file.crc = static_cast<uint32_t>(crc32_z(0, static_cast<const Bytef*>(bytes), static_cast<size_t>(length)));
    writer.addFile(std::move(file));
}

void abandonRecording(const char* why) {
    delete recording.recorder;
    recording.recorder = nullptr;
    recording.engine.Printf(Q3_PRINT_ERROR, "%s%s\n", kRecordingEnded, why);
    // Whoever started the engine for the recording's sake need not wait for the demo's end.
    if (std::getenv(kWatchSocket)) recording.engine.Cmd_ExecuteText(Q3_EXEC_APPEND, "quit\n");
}

} // namespace q3rt
