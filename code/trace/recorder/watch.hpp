#pragma once
// The interposer's report to the program that started the engine. Every function is safe to call when nobody watches.

#include "abi/ref_tables.h"

namespace q3rt {

void startWatching();
void stopWatching();
void watchRegistered(const glconfig_t& config);
void watchMapState(bool registrationEnded);
void watchFrameBegin();
/// Before the module's EndFrame: asks for the picture if this frame's is wanted.
void watchFrameEnding();
/// After it: sends the message.
void watchFrameEnded();
/// The module's video frame. True if it was meant for us and not for the engine.
bool watchPicture(const byte* bgr, int size);

} // namespace q3rt
