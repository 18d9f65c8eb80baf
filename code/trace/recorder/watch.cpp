#include "trace/recorder/watch.hpp"

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string>
#include <sys/socket.h>
#include <vector>

#include "trace/recorder/recorder.hpp"
#include "trace/recorder/watch_protocol.hpp"

namespace q3rt {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kUserCreated = 0x80; ///< the engine's cvar flag

struct Watch {
    int socket = -1;
    long every = 0, lastFrame = 0; ///< 0: no pictures, no end
    int width = 0, height = 0;
    bool worldReady = false, pictureWanted = false;
    int32_t frame = 0; ///< world frames that have ended
    Clock::time_point begin;
    std::vector<byte> capture, encode, picture;
};
Watch* watch = nullptr;

long numberFrom(const char* variable) {
    const char* text = std::getenv(variable);
    return text ? std::strtol(text, nullptr, 10) : 0;
}

bool sendAll(const void* data, size_t bytes) {
    const char* at = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t sent = send(watch->socket, at, bytes, MSG_NOSIGNAL);
        if (sent <= 0) return false;
        at += sent;
        bytes -= static_cast<size_t>(sent);
    }
    return true;
}

void sendMessage(WatchMessage message, const char* text) {
    message.textBytes = static_cast<uint32_t>(std::strlen(text));
    message.width = watch->width;
    message.height = watch->height;
    message.pictureBytes = static_cast<uint32_t>(watch->picture.size());
    const bool sent = sendAll(&message, sizeof message) && sendAll(text, message.textBytes) &&
                      sendAll(watch->picture.data(), watch->picture.size());
    watch->picture.clear();
    // Whoever started the engine is gone: nobody wants the rest.
    if (!sent) recording.engine.Cmd_ExecuteText(Q3_EXEC_APPEND, "quit\n");
}

/// The engine links all of them, in both directions from any.
void sendCvars() {
    const cvar_t* cvar = recording.engine.Cvar_Get("q3rt_stats", "", 0);
    if (!cvar) return;
    while (cvar->prev)
        cvar = cvar->prev;
    std::string names;
    for (; cvar; cvar = cvar->next) {
        if (cvar->flags & kUserCreated) names += WatchMessage::kUndeclared;
        names += cvar->name;
        names += '\n';
    }
    WatchMessage message;
    message.frame = WatchMessage::kCvars;
    sendMessage(message, names.c_str());
}

} // namespace

void startWatching() {
    if (!std::getenv(kWatchSocket) || watch) return;
    watch = new Watch;
    watch->socket = static_cast<int>(numberFrom(kWatchSocket));
    watch->every = numberFrom(kWatchEvery);
    watch->lastFrame = numberFrom(kWatchFrames);
}

void stopWatching() {
    delete watch;
    watch = nullptr;
}

void watchRegistered(const glconfig_t& config) {
    if (!watch) return;
    watch->width = config.vidWidth;
    watch->height = config.vidHeight;
    if (numberFrom(kWatchStats) != 0) recording.engine.Cvar_Set("q3rt_wantStats", "1");
    WatchMessage message;
    message.frame = WatchMessage::kStarted;
    sendMessage(message, config.renderer_string);
}

void watchMapState(bool registrationEnded) {
    if (watch) watch->worldReady = registrationEnded;
}

void watchFrameBegin() {
    if (watch) watch->begin = Clock::now();
}

void watchFrameEnding() {
    if (!watch || !watch->worldReady || watch->every <= 0 || watch->frame % watch->every != 0) return;
    const size_t bytes = static_cast<size_t>(watch->width) * static_cast<size_t>(watch->height) * 4 + 64;
    watch->capture.resize(bytes);
    watch->encode.resize(bytes);
    watch->pictureWanted = true;
    recording.inner.TakeVideoFrame(watch->width, watch->height, watch->capture.data(), watch->encode.data(), 0);
}

bool watchPicture(const byte* bgr, int size) {
    if (!watch || !watch->pictureWanted) return false;
    watch->picture.assign(bgr, bgr + size);
    watch->pictureWanted = false;
    return true;
}

void watchFrameEnded() {
    if (!watch || !watch->worldReady) return;
    WatchMessage message;
    message.frame = watch->frame++;
    message.wallMs = std::chrono::duration<double, std::milli>(Clock::now() - watch->begin).count();
    const cvar_t* stats = recording.engine.Cvar_Get("q3rt_stats", "", 0);
    sendMessage(message, stats ? stats->string : "");
    // By the first frame of the world engine, game and renderer have declared theirs.
    if (watch->frame == 1 && numberFrom(kWatchCvars) != 0) sendCvars();
    if (watch->frame == watch->lastFrame) recording.engine.Cmd_ExecuteText(Q3_EXEC_APPEND, "quit\n");
}

} // namespace q3rt
