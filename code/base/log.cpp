#include "base/log.hpp"

#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <string>
#include <unordered_set>

namespace q3rt {
namespace {

struct Log {
    std::mutex mutex;
    LogSink sink;
    std::unordered_set<std::string> loggedOnce;
};

Log& theLog() {
    static Log log;
    return log;
}

std::string formatArguments(const char* format, va_list arguments) {
    va_list measured;
    va_copy(measured, arguments);
    const int length = std::vsnprintf(nullptr, 0, format, measured);
    va_end(measured);
    std::string text(length > 0 ? static_cast<size_t>(length) : 0, '\0');
    std::vsnprintf(text.data(), text.size() + 1, format, arguments);
    return text;
}

void emitLine(LogLevel level, const std::string& line) {
    // The sink may jump out (engine imports can), so the lock is not held while it runs.
    LogSink sink;
    {
        std::scoped_lock lock(theLog().mutex);
        sink = theLog().sink;
    }
    if (sink)
        sink(level, line);
    else if (level != LogLevel::Developer)
        std::fprintf(stderr, "%s%s\n",
                     level == LogLevel::Warning ? "warning: "
                     : level == LogLevel::Error ? "error: "
                                                : "",
                     line.c_str());
}

} // namespace

void setLogSink(LogSink sink) {
    std::scoped_lock lock(theLog().mutex);
    theLog().sink = std::move(sink);
}

void logLine(LogLevel level, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const std::string line = formatArguments(format, arguments);
    va_end(arguments);
    emitLine(level, line);
}

void logLineOnce(LogLevel level, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const std::string line = formatArguments(format, arguments);
    va_end(arguments);
    {
        std::scoped_lock lock(theLog().mutex);
        if (!theLog().loggedOnce.insert(line).second) return;
    }
    emitLine(level, line);
}

void clearLoggedOnce() {
    std::scoped_lock lock(theLog().mutex);
    theLog().loggedOnce.clear();
}

} // namespace q3rt
