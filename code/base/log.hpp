#pragma once
// One log for all code. Where lines go is the host's choice: the engine's console, or stderr.

#include <functional>
#include <string_view>

namespace q3rt {

enum class LogLevel { Info, Developer, Warning, Error };

/// Receives one complete line, without a newline.
using LogSink = std::function<void(LogLevel, std::string_view line)>;

/// Replaces the sink; an empty one restores stderr. Main thread only.
void setLogSink(LogSink sink);

[[gnu::format(printf, 2, 3)]] void logLine(LogLevel level, const char* format, ...);
/// Logs a line only the first time that this exact text comes up since clearLoggedOnce().
[[gnu::format(printf, 2, 3)]] void logLineOnce(LogLevel level, const char* format, ...);
void clearLoggedOnce();

} // namespace q3rt
