#pragma once
// What a renderer may ask of whoever hosts it: the engine, or our own headless host. Implementations are allowed to
// throw; under the engine an import that jumps is turned into an exception by the guard (engine/guard.hpp), so code
// that calls these may own anything.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file_source.hpp"
#include "base/log.hpp"

namespace q3rt {

/// Cvar flags of the engine.
namespace cvarFlag {
inline constexpr int kArchive = 0x1, kInit = 0x10, kLatch = 0x20, kReadOnly = 0x40, kTemporary = 0x100, kCheat = 0x200;
}

/// A registered cvar; values are those the engine holds now.
class Cvar {
  public:
    virtual ~Cvar() = default;
    virtual std::string_view string() const = 0; ///< until it changes
    virtual float value() const = 0;
    virtual int integer() const = 0;
    /// True once after each change.
    virtual bool takeModified() = 0;
};

class EngineServices : public FileSource {
  public:
    virtual void print(LogLevel level, std::string_view line) = 0;
    virtual int milliseconds() = 0;
    /// Registers (or finds) a cvar; the pointer lives until the module is shut down with its window.
    virtual Cvar& cvar(std::string_view name, std::string_view defaultValue, int flags) = 0;
    virtual void describeCvar(std::string_view name, std::string_view description) = 0;
    virtual void limitCvar(std::string_view name, float minimum, float maximum, bool integral) = 0;
    virtual void setCvar(std::string_view name, std::string_view value) = 0;
    virtual void addCommand(std::string_view name, void (*function)()) = 0;
    virtual void removeCommand(std::string_view name) = 0;
    virtual std::vector<std::string> commandArguments() = 0;
    virtual void executeText(std::string_view text) = 0; ///< appended to the command buffer
    /// Writes into the game folder of the user's home.
    virtual void writeFile(std::string_view name, std::span<const std::byte> bytes) = 0;
    virtual bool fileExists(std::string_view name) = 0; ///< in the home folder only
    virtual int playCinematic(std::string_view name, int x, int y, int width, int height, int bits) = 0;
    virtual int runCinematic(int handle) = 0;
    virtual void uploadCinematic(int handle) = 0; ///< calls back Renderer::uploadCinematic
    virtual void writeVideoFrame(std::span<const uint8_t> bytes) = 0;
    /// False on our headless host: no SDL, no window, frames stay in images.
    virtual bool wantsWindow() = 0;
    virtual void inputInit(void* sdlWindow) = 0;
    virtual void inputShutdown() = 0;
    virtual void inputRestart() = 0;
};

} // namespace q3rt
