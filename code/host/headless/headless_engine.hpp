#pragma once
// Our own engine side of the renderer interface: files from the search path, cvars, commands, a clock that stands where
// it is put. It loads any module with this interface (ours, or the packaged OpenGL ones under an X server) and hands
// out its export table. Errors that the module raises come back as exceptions, after the engine's real order of events:
// Shutdown and BeginRegistration inside the Error call, then a longjmp over the module's frames.
// One at a time in a process: the interface has no context pointer.

#include <csetjmp>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "abi/ref_tables.h"
#include "base/file_source.hpp"
#include "base/log.hpp"
#include "host/headless/cvar_table.hpp"
#include "host/headless/host_frame.hpp"

namespace q3rt {

class HeadlessEngine {
  public:
    /// `files` outlives this object. Defines the read-only cvar q3rt_headless as 1: our modules open no window then.
    explicit HeadlessEngine(FileSource& files);
    /// Shuts the module down and unloads it.
    ~HeadlessEngine();
    HeadlessEngine(const HeadlessEngine&) = delete;
    HeadlessEngine& operator=(const HeadlessEngine&) = delete;

    CvarTable cvars;
    int clockMs = 0;           ///< what Milliseconds answers
    bool showsMessages = true; ///< false: only errors, and warnings of settings, reach the log
    /// The warnings that didn't reach it: the first, and how many more there were. Empty: none.
    std::string unshownWarnings() const;

    /// Throws UsageError if the file is no renderer module.
    void loadModule(const std::filesystem::path& path);
    void unloadModule();
    /// Also seeds the C library's generator, from which noise tables are filled, so that runs agree.
    const glconfig_t& beginRegistration();
    void shutdown(bool destroyWindow);
    const glconfig_t& config() const { return m_config; }

    /// Runs calls into the module: `enter([&](const refexport_t& module) { ... })`. The function must own nothing, for
    /// the module's errors jump over it. Throws ContentError for a drop, DeviceError for a fatal error.
    template <class Function>
    void enter(Function&& function) {
        static_assert(std::is_trivially_destructible_v<std::remove_reference_t<Function>>);
        enterErased([](void* data,
                       const refexport_t& module) { (*static_cast<std::remove_reference_t<Function>*>(data))(module); },
                    &function);
    }
    /// EndFrame, with the frame's pixels if they are wanted (asked for as the engine's video capture does).
    std::optional<HostFrame> endFrame(bool capture);
    /// Executes a command that the module registered. False if there is none of that name.
    bool runCommand(const std::vector<std::string>& arguments);

    /// Files that the module read, with names as asked for, in lower case.
    const std::set<std::string>& filesRead() const { return m_filesRead; }
    /// Files that the module wrote; nothing goes to disk.
    std::map<std::string, std::vector<std::byte>>& filesWritten() { return m_filesWritten; }
    /// Cinematics: the host answers when the module plays, runs and uploads them. Empty: there are none.
    struct Cinematics {
        std::function<int(std::string_view name)> play;
        std::function<int(int handle)> run;
        std::function<void(int handle)> upload; ///< may call the module's UploadCinematic through moduleTable()
    };
    Cinematics cinematics;
    const refexport_t& moduleTable() const { return *m_module; }

    // --- fault injection ---
    /// Imports called since the last reset.
    int importCount() const { return m_importCount; }
    /// Resets the count; the `number`-th import from now raises ERR_DROP instead of doing its work. 0: none.
    void raiseErrorAtImport(int number);
    /// Anything that the module still holds of the engine: lent files, lists, commands. Empty text: nothing.
    std::string heldResources() const;

  private:
    friend struct HeadlessImports;
    using Thunk = void (*)(void* data, const refexport_t& module);
    void enterErased(Thunk function, void* data);
    void countImport();
    void takeVideoFrame(const byte* bgr, int size);
    [[noreturn]] void raiseError(int code);

    FileSource& m_files;
    void* m_library = nullptr;
    std::filesystem::path m_modulePath;
    refexport_t* m_module = nullptr;
    glconfig_t m_config{};
    bool m_started = false; ///< BeginRegistration ran, Shutdown(1) didn't yet
    std::jmp_buf* m_jump = nullptr;
    char m_errorText[4096] = {};
    int m_errorCode = 0;
    int m_errorDepth = 0;
    int m_importCount = 0, m_errorAtImport = 0;
    std::string m_firstUnshown;
    size_t m_unshownCount = 0;
    std::vector<void*> m_lentFiles; ///< a stack: given back in reverse order
    std::set<char**> m_lentLists;
    std::map<std::string, void (*)()> m_commands;
    std::vector<std::string> m_commandArguments;
    std::set<std::string> m_filesRead;
    std::map<std::string, std::vector<std::byte>> m_filesWritten;
    std::vector<void*> m_hunk; ///< freed at every registration end, as the engine's
    HostFrame m_frame;
};

} // namespace q3rt
