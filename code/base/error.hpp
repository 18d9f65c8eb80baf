#pragma once
// The three kinds of failure that reach a user. Each message is one line that names the file, device or argument and
// says what to do about it. Expected misses (a file that may be absent) are std::optional, never an exception.

#include <stdexcept>
#include <string>

namespace q3rt {

/// Content that can't be used: a damaged map, model, image, script or recording.
class ContentError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A device, driver or Vulkan call that failed.
class DeviceError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A bad argument, cvar or engine call.
class UsageError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// printf into a std::string.
[[gnu::format(printf, 1, 2)]] std::string formatText(const char* format, ...);

} // namespace q3rt
