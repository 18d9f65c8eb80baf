#include "engine/engine_imports.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "base/error.hpp"
#include "formats/text_case.hpp"

namespace q3rt {
namespace {

/// The engine cuts a printed message at 4096 characters.
constexpr size_t kPrintBytes = 4000;

/// A file's bytes between the engine's stack and ours.
struct FetchedFile {
    void* bytes = nullptr;
    long length = -1;
    ~FetchedFile() { std::free(bytes); }
};

} // namespace

class EngineImports::EngineCvar : public Cvar {
  public:
    explicit EngineCvar(cvar_t* cvar)
        : m_cvar(cvar) {}
    std::string_view string() const override { return m_cvar->string ? m_cvar->string : ""; }
    float value() const override { return m_cvar->value; }
    int integer() const override { return m_cvar->integer; }
    bool takeModified() override {
        const bool modified = m_cvar->modificationCount != m_seenModifications;
        m_seenModifications = m_cvar->modificationCount;
        m_cvar->modified = 0;
        return modified;
    }
    cvar_t* raw() const { return m_cvar; }

  private:
    cvar_t* m_cvar;
    int m_seenModifications = 0; ///< the engine counts from 1, so a new cvar is modified once
};

EngineImports::EngineImports(const refimport_t& imports, Guard& guard, void (*commandEntry)())
    : m_imports(imports)
    , m_guard(guard)
    , m_commandEntry(commandEntry) {}

EngineImports::~EngineImports() = default;

std::optional<std::vector<std::byte>> EngineImports::read(std::string_view name) {
    if (name.empty()) return std::nullopt; // a fatal error in the engine
    const std::string path(name);
    FetchedFile file;
    m_guard.call([&] {
        void* lent = nullptr;
        const long length = m_imports.FS_ReadFile(path.c_str(), &lent);
        if (!lent) return;
        file.bytes = std::malloc(static_cast<size_t>(std::max(length, 1L)));
        file.length = file.bytes ? length : -1;
        if (file.bytes && length > 0) std::memcpy(file.bytes, lent, static_cast<size_t>(length));
        m_imports.FS_FreeFile(lent);
    });
    if (file.length < 0) return std::nullopt;
    const auto* first = static_cast<const std::byte*>(file.bytes);
    return std::vector<std::byte>(first, first + file.length);
}

std::vector<std::string> EngineImports::list(std::string_view directory, std::string_view extension) {
    const std::string folder(directory), ending(extension);
    int count = 0;
    char** names = m_guard.call([&] { return m_imports.FS_ListFiles(folder.c_str(), ending.c_str(), &count); });
    std::vector<std::string> result;
    if (!names) return result;
    for (int i = 0; i < count && names[i]; ++i)
        result.emplace_back(names[i]);
    m_guard.call([&] { m_imports.FS_FreeFileList(names); });
    return result;
}

void EngineImports::print(LogLevel level, std::string_view line) {
    if (std::this_thread::get_id() == m_engineThread) return printNow(level, line);
    std::scoped_lock lock(m_deferredMutex);
    m_deferred.push_back({level, std::string(line)});
}

void EngineImports::printNow(LogLevel level, std::string_view line) {
    const int engineLevel = level == LogLevel::Developer ? Q3_PRINT_DEVELOPER
                            : level == LogLevel::Warning ? Q3_PRINT_WARNING
                            : level == LogLevel::Error   ? Q3_PRINT_ERROR
                                                         : Q3_PRINT_ALL;
    do {
        const int length = static_cast<int>(std::min(line.size(), kPrintBytes));
        const char* text = line.data();
        const char* end = line.size() > kPrintBytes ? "" : "\n";
        m_guard.call([=, this] { m_imports.Printf(engineLevel, "%.*s%s", length, text, end); },
                     ImportKind::NeverThrows);
        line.remove_prefix(static_cast<size_t>(length));
    } while (!line.empty());
}

void EngineImports::printDeferred() {
    std::vector<DeferredLine> lines;
    {
        std::scoped_lock lock(m_deferredMutex);
        lines.swap(m_deferred);
    }
    for (const DeferredLine& line : lines)
        printNow(line.level, line.text);
}

int EngineImports::milliseconds() {
    return m_guard.call([&] { return m_imports.Milliseconds(); });
}

Cvar& EngineImports::cvar(std::string_view name, std::string_view defaultValue, int flags) {
    const std::string cvarName(name), value(defaultValue);
    // Asked for every time: that is when a latched value takes effect.
    cvar_t* raw = m_guard.call([&] { return m_imports.Cvar_Get(cvarName.c_str(), value.c_str(), flags); });
    if (!raw) throw UsageError("the engine refuses the cvar name '" + cvarName + "'");
    std::unique_ptr<EngineCvar>& known = m_cvars[toLowerAscii(name)];
    if (!known || known->raw() != raw) known = std::make_unique<EngineCvar>(raw);
    return *known;
}

cvar_t* EngineImports::findCvar(const std::string& name) {
    const auto known = m_cvars.find(toLowerAscii(name));
    return known == m_cvars.end() ? nullptr : known->second->raw();
}

void EngineImports::describeCvar(std::string_view name, std::string_view description) {
    cvar_t* raw = findCvar(std::string(name));
    const std::string text(description);
    if (raw) m_guard.call([&] { m_imports.Cvar_SetDescription(raw, text.c_str()); });
}

void EngineImports::limitCvar(std::string_view name, float minimum, float maximum, bool integral) {
    cvar_t* raw = findCvar(std::string(name));
    if (raw) m_guard.call([&] { m_imports.Cvar_CheckRange(raw, minimum, maximum, integral); });
}

void EngineImports::setCvar(std::string_view name, std::string_view value) {
    const std::string cvarName(name), text(value);
    m_guard.call([&] { m_imports.Cvar_Set(cvarName.c_str(), text.c_str()); });
}

void EngineImports::addCommand(std::string_view name, void (*function)()) {
    const std::string command(name);
    const bool known = m_commands.contains(toLowerAscii(name));
    if (!known) m_guard.call([&] { m_imports.Cmd_AddCommand(command.c_str(), m_commandEntry); });
    m_commands[toLowerAscii(name)] = function;
}

void EngineImports::removeCommand(std::string_view name) {
    const std::string command(name);
    m_commands.erase(toLowerAscii(name));
    m_guard.call([&] { m_imports.Cmd_RemoveCommand(command.c_str()); }, ImportKind::NeverThrows);
}

void EngineImports::removeAllCommands() {
    while (!m_commands.empty())
        removeCommand(std::string(m_commands.begin()->first));
}

void EngineImports::runCommand() {
    const std::vector<std::string> arguments = commandArguments();
    if (arguments.empty()) return;
    const auto command = m_commands.find(toLowerAscii(arguments[0]));
    if (command != m_commands.end()) command->second();
}

std::vector<std::string> EngineImports::commandArguments() {
    const int count = m_guard.call([&] { return m_imports.Cmd_Argc(); });
    std::vector<std::string> arguments;
    for (int i = 0; i < count; ++i)
        arguments.emplace_back(m_guard.call([&] { return m_imports.Cmd_Argv(i); }));
    return arguments;
}

void EngineImports::executeText(std::string_view text) {
    const std::string commands(text);
    m_guard.call([&] { m_imports.Cmd_ExecuteText(Q3_EXEC_APPEND, commands.c_str()); });
}

void EngineImports::writeFile(std::string_view name, std::span<const std::byte> bytes) {
    const std::string path(name);
    m_guard.call([&] { m_imports.FS_WriteFile(path.c_str(), bytes.data(), static_cast<int>(bytes.size())); });
}

bool EngineImports::fileExists(std::string_view name) {
    const std::string path(name);
    return m_guard.call([&] { return m_imports.FS_FileExists(path.c_str()); }) != 0;
}

int EngineImports::playCinematic(std::string_view name, int x, int y, int width, int height, int bits) {
    const std::string file(name);
    return m_guard.call([&] { return m_imports.CIN_PlayCinematic(file.c_str(), x, y, width, height, bits); });
}

int EngineImports::runCinematic(int handle) {
    return m_guard.call([&] { return m_imports.CIN_RunCinematic(handle); });
}

void EngineImports::uploadCinematic(int handle) {
    m_guard.call([&] { m_imports.CIN_UploadCinematic(handle); }, ImportKind::Reentrant);
}

void EngineImports::writeVideoFrame(std::span<const uint8_t> bytes) {
    m_guard.call([&] { m_imports.CL_WriteAVIVideoFrame(bytes.data(), static_cast<int>(bytes.size())); });
}

bool EngineImports::wantsWindow() {
    // Only our own host defines this cvar; the engine answers 0 for a name that it doesn't know.
    return m_guard.call([&] { return m_imports.Cvar_VariableIntegerValue("q3rt_headless"); }) == 0;
}

void EngineImports::inputInit(void* sdlWindow) {
    m_guard.call([&] { m_imports.IN_Init(sdlWindow); });
}

void EngineImports::inputShutdown() {
    m_guard.call([&] { m_imports.IN_Shutdown(); }, ImportKind::NeverThrows);
}

void EngineImports::inputRestart() {
    m_guard.call([&] { m_imports.IN_Restart(); });
}

} // namespace q3rt
