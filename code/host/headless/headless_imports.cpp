#include "host/headless/headless_imports.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/log.hpp"
#include "formats/text_case.hpp"
#include "host/headless/headless_engine.hpp"

namespace q3rt {
namespace {

HeadlessEngine* theEngine = nullptr;

char* copyText(const std::string& text) {
    char* copy = static_cast<char*>(std::malloc(text.size() + 1));
    if (copy) std::memcpy(copy, text.c_str(), text.size() + 1);
    return copy;
}

} // namespace

/// Such a message names the setting first: whoever set it wants to know.
bool HeadlessImports::concernsSetting(std::string_view message) {
    return theEngine->cvars.find(message.substr(0, message.find_first_of(": "))) != nullptr;
}

// Every function counts itself first, while it owns nothing, because the injected error jumps from there.
void HeadlessImports::bind(HeadlessEngine* engine) { theEngine = engine; }

void HeadlessImports::print(int level, const char* format, ...) {
    theEngine->countImport();
    va_list arguments;
    va_start(arguments, format);
    char text[4096];
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const bool shown =
        theEngine->showsMessages || level == Q3_PRINT_ERROR || (level == Q3_PRINT_WARNING && concernsSetting(text));
    const size_t length = std::strlen(text);
    if (length > 0 && text[length - 1] == '\n') text[length - 1] = 0;
    if (!shown && level == Q3_PRINT_WARNING && theEngine->m_unshownCount++ == 0) theEngine->m_firstUnshown = text;
    if (!shown) return;
    const LogLevel levels[] = {LogLevel::Info, LogLevel::Developer, LogLevel::Warning, LogLevel::Error};
    logLine(level >= 0 && level < 4 ? levels[level] : LogLevel::Info, "%s", text);
}

void HeadlessImports::fail(int code, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(theEngine->m_errorText, sizeof theEngine->m_errorText, format, arguments);
    va_end(arguments);
    theEngine->raiseError(code);
}

refimport_t HeadlessImports::table() {
    refimport_t t{};
    t.Printf = print;
    t.Error = fail;
    t.Milliseconds = []() -> int {
        theEngine->countImport();
        return theEngine->clockMs;
    };
    t.Hunk_Alloc = [](int size, int) -> void* {
        theEngine->countImport();
        constexpr size_t kAlignment = 32; // as the engine's
        const size_t rounded = (static_cast<size_t>(size) + kAlignment) / kAlignment * kAlignment;
        void* block = std::aligned_alloc(kAlignment, rounded);
        std::memset(block, 0, rounded);
        theEngine->m_hunk.push_back(block);
        return block;
    };
    t.Hunk_AllocateTempMemory = [](int size) -> void* {
        theEngine->countImport();
        return std::malloc(static_cast<size_t>(size) + 1);
    };
    t.Hunk_FreeTempMemory = [](void* memory) {
        theEngine->countImport();
        std::free(memory);
    };
    t.Malloc = [](int size) -> void* {
        theEngine->countImport();
        return std::malloc(static_cast<size_t>(size) + 1);
    };
    t.Free = [](void* memory) {
        theEngine->countImport();
        std::free(memory);
    };
    addCvarImports(t);
    addFileImports(t);
    addOtherImports(t);
    return t;
}

void HeadlessImports::addCvarImports(refimport_t& t) {
    t.Cvar_Get = [](const char* name, const char* value, int flags) -> cvar_t* {
        theEngine->countImport();
        return theEngine->cvars.get(name, value ? value : "", flags);
    };
    t.Cvar_Set = [](const char* name, const char* value) {
        theEngine->countImport();
        theEngine->cvars.set(name, value ? value : "");
    };
    t.Cvar_SetValue = [](const char* name, float value) {
        theEngine->countImport();
        char text[64];
        std::snprintf(text, sizeof text, "%g", value);
        theEngine->cvars.set(name, text);
    };
    t.Cvar_CheckRange = [](cvar_t* cvar, float minimum, float maximum, qboolean integral) {
        theEngine->countImport();
        theEngine->cvars.setRange(cvar, minimum, maximum, integral != 0);
    };
    t.Cvar_SetDescription = [](cvar_t* cvar, const char* description) {
        theEngine->countImport();
        theEngine->cvars.describe(cvar, description ? description : "");
    };
    t.Cvar_VariableIntegerValue = [](const char* name) -> int {
        theEngine->countImport();
        const cvar_t* cvar = theEngine->cvars.find(name);
        return cvar ? cvar->integer : 0;
    };
    t.Cmd_AddCommand = [](const char* name, void (*command)()) {
        theEngine->countImport();
        theEngine->m_commands[name] = command;
    };
    t.Cmd_RemoveCommand = [](const char* name) {
        // Not counted: the engine's own can't fail.
        theEngine->m_commands.erase(name);
    };
    t.Cmd_Argc = []() -> int {
        theEngine->countImport();
        return static_cast<int>(theEngine->m_commandArguments.size());
    };
    t.Cmd_Argv = [](int index) -> char* {
        theEngine->countImport();
        static char none[1] = {0};
        const auto at = static_cast<size_t>(index);
        return at < theEngine->m_commandArguments.size() ? theEngine->m_commandArguments[at].data() : none;
    };
    t.Cmd_ExecuteText = [](int, const char* text) {
        theEngine->countImport();
        logLine(LogLevel::Developer, "the module asks for the command: %s", text);
    };
}

void HeadlessImports::addFileImports(refimport_t& t) {
    t.FS_FileIsInPAK = [](const char* name, int* checksum) -> int {
        theEngine->countImport();
        if (checksum) *checksum = 0;
        return theEngine->m_files.read(name) ? 1 : -1;
    };
    t.FS_ReadFile = [](const char* name, void** buffer) -> long {
        theEngine->countImport();
        if (buffer) *buffer = nullptr;
        const auto file = theEngine->m_files.read(name);
        if (!file) return -1;
        theEngine->m_filesRead.insert(toLowerAscii(name));
        if (!buffer) return static_cast<long>(file->size());
        auto* lent = static_cast<char*>(std::malloc(file->size() + 1));
        if (!file->empty()) std::memcpy(lent, file->data(), file->size());
        lent[file->size()] = 0;
        theEngine->m_lentFiles.push_back(lent);
        *buffer = lent;
        return static_cast<long>(file->size());
    };
    t.FS_FreeFile = [](void* buffer) {
        // Not counted: the engine's own gives memory back without a chance to fail.
        if (theEngine->m_lentFiles.empty() || theEngine->m_lentFiles.back() != buffer)
            logLine(LogLevel::Error, "the module gave back a file out of order");
        std::erase(theEngine->m_lentFiles, buffer);
        std::free(buffer);
    };
    t.FS_ListFiles = [](const char* directory, const char* extension, int* count) -> char** {
        theEngine->countImport();
        const std::vector<std::string> names = theEngine->m_files.list(directory, extension);
        *count = static_cast<int>(names.size());
        if (names.empty()) return nullptr;
        auto** list = static_cast<char**>(std::calloc(names.size() + 1, sizeof(char*)));
        for (size_t i = 0; i < names.size(); ++i)
            list[i] = copyText(names[i]);
        theEngine->m_lentLists.insert(list);
        return list;
    };
    t.FS_FreeFileList = [](char** list) {
        if (!list) return;
        theEngine->m_lentLists.erase(list);
        for (char** name = list; *name; ++name)
            std::free(*name);
        std::free(list);
    };
    t.FS_WriteFile = [](const char* name, const void* bytes, int size) {
        theEngine->countImport();
        const auto* first = static_cast<const std::byte*>(bytes);
        theEngine->m_filesWritten[name] = std::vector<std::byte>(first, first + size);
    };
    t.FS_FileExists = [](const char* name) -> qboolean {
        theEngine->countImport();
        return theEngine->m_filesWritten.contains(name);
    };
}

void HeadlessImports::addOtherImports(refimport_t& t) {
    t.CM_ClusterPVS = [](int) -> byte* {
        theEngine->countImport();
        // Everything is visible; no map has more clusters than bits here (the format's own limit is far below).
        static std::vector<byte> row(size_t{1} << 16, 0xff);
        return row.data();
    };
    t.CM_DrawDebugSurface = [](void (*)(int, int, float*)) { theEngine->countImport(); };
    t.CIN_UploadCinematic = [](int handle) {
        theEngine->countImport();
        if (theEngine->cinematics.upload) theEngine->cinematics.upload(handle);
    };
    t.CIN_PlayCinematic = [](const char* name, int, int, int, int, int) -> int {
        theEngine->countImport();
        return theEngine->cinematics.play ? theEngine->cinematics.play(name) : -1;
    };
    t.CIN_RunCinematic = [](int handle) -> int {
        theEngine->countImport();
        return theEngine->cinematics.run ? theEngine->cinematics.run(handle) : 0;
    };
    t.CL_WriteAVIVideoFrame = [](const byte* bytes, int size) {
        theEngine->countImport();
        theEngine->takeVideoFrame(bytes, size);
    };
    t.IN_Init = [](void*) { theEngine->countImport(); };
    t.IN_Shutdown = []() { theEngine->countImport(); };
    t.IN_Restart = []() { theEngine->countImport(); };
    t.ftol = [](float value) -> long { return static_cast<long>(value); };
    t.Sys_SetEnv = [](const char* name, const char* value) { setenv(name, value ? value : "", 1); };
    t.Sys_GLimpSafeInit = []() {};
    t.Sys_GLimpInit = []() {};
    t.Sys_LowPhysicalMemory = []() -> qboolean { return 0; };
}

} // namespace q3rt
