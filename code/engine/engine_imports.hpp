#pragma once
// EngineServices over the engine's import table. Every call goes through the guard: it runs on the engine's stack and
// throws EngineJump here if the engine jumped away. Bytes that the engine lends are copied and given back inside one
// call, in stack order, so that no jump can leave its temporary memory allocated.

#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "abi/ref_tables.h"
#include "engine/guard.hpp"
#include "engine/services.hpp"

namespace q3rt {

class EngineImports : public EngineServices {
  public:
    /// `imports` and `guard` outlive this object. `commandEntry` is what the engine calls for any command.
    EngineImports(const refimport_t& imports, Guard& guard, void (*commandEntry)());
    ~EngineImports() override;

    std::optional<std::vector<std::byte>> read(std::string_view name) override;
    std::vector<std::string> list(std::string_view directory, std::string_view extension) override;
    void print(LogLevel level, std::string_view line) override;
    int milliseconds() override;
    Cvar& cvar(std::string_view name, std::string_view defaultValue, int flags) override;
    void describeCvar(std::string_view name, std::string_view description) override;
    void limitCvar(std::string_view name, float minimum, float maximum, bool integral) override;
    void setCvar(std::string_view name, std::string_view value) override;
    void addCommand(std::string_view name, void (*function)()) override;
    void removeCommand(std::string_view name) override;
    std::vector<std::string> commandArguments() override;
    void executeText(std::string_view text) override;
    void writeFile(std::string_view name, std::span<const std::byte> bytes) override;
    bool fileExists(std::string_view name) override;
    int playCinematic(std::string_view name, int x, int y, int width, int height, int bits) override;
    int runCinematic(int handle) override;
    void uploadCinematic(int handle) override;
    void writeVideoFrame(std::span<const uint8_t> bytes) override;
    bool wantsWindow() override;
    void inputInit(void* sdlWindow) override;
    void inputShutdown() override;
    void inputRestart() override;

    /// Runs the function registered for the command that the engine executes now. Called inside a guarded body.
    void runCommand();
    void removeAllCommands();
    /// Prints what worker threads logged since the last call.
    void printDeferred();

  private:
    class EngineCvar;
    struct DeferredLine {
        LogLevel level;
        std::string text;
    };
    cvar_t* findCvar(const std::string& name);
    void printNow(LogLevel level, std::string_view line);

    const refimport_t& m_imports;
    Guard& m_guard;
    void (*m_commandEntry)();
    std::thread::id m_engineThread = std::this_thread::get_id();
    std::map<std::string, std::unique_ptr<EngineCvar>> m_cvars; ///< by lower-case name
    std::map<std::string, void (*)()> m_commands;               ///< by lower-case name
    std::mutex m_deferredMutex;
    std::vector<DeferredLine> m_deferred;
};

} // namespace q3rt
