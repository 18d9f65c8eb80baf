#include "host/headless/headless_engine.hpp"

#include <cstdlib>
#include <cstring>
#include <dlfcn.h>

#include "base/error.hpp"
#include "host/headless/headless_imports.hpp"

namespace q3rt {

HeadlessEngine::HeadlessEngine(FileSource& files)
    : m_files(files) {
    constexpr int kReadOnly = 0x40;
    cvars.get("q3rt_headless", "1", kReadOnly);
    HeadlessImports::bind(this);
}

HeadlessEngine::~HeadlessEngine() {
    try {
        unloadModule();
    } catch (const std::exception& error) {
        logLine(LogLevel::Error, "%s", error.what());
    }
    for (void* block : m_hunk)
        std::free(block);
    HeadlessImports::bind(nullptr);
}

void HeadlessEngine::loadModule(const std::filesystem::path& path) {
    unloadModule();
    // A name without a slash would be looked for in the system's library folders.
    const std::filesystem::path full = std::filesystem::absolute(path);
    m_library = dlopen(full.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!m_library) throw UsageError(formatText("%s: not a renderer module: %s", path.c_str(), dlerror()));
    const auto getRefApi = reinterpret_cast<GetRefAPI_t>(dlsym(m_library, "GetRefAPI"));
    m_modulePath = path;
    if (getRefApi) {
        refimport_t imports = HeadlessImports::table();
        m_module = getRefApi(REF_API_VERSION, &imports);
    }
    if (m_module) return;
    dlclose(m_library);
    m_library = nullptr;
    throw UsageError(formatText("%s: not a renderer module for interface version %d", path.c_str(), REF_API_VERSION));
}

void HeadlessEngine::unloadModule() {
    if (!m_library) return;
    if (m_started) shutdown(true);
    m_module = nullptr;
    dlclose(m_library);
    m_library = nullptr;
}

const glconfig_t& HeadlessEngine::beginRegistration() {
    std::srand(1);
    m_started = true;
    enter([this](const refexport_t& module) { module.BeginRegistration(&m_config); });
    return m_config;
}

void HeadlessEngine::shutdown(bool destroyWindow) {
    if (destroyWindow) m_started = false;
    enter([destroyWindow](const refexport_t& module) { module.Shutdown(destroyWindow); });
    for (void* block : m_hunk)
        std::free(block);
    m_hunk.clear();
}

// Kept free of anything with a destructor: longjmp comes back into this frame.
void HeadlessEngine::enterErased(Thunk function, void* data) {
    if (!m_module) throw UsageError("no renderer module is loaded");
    std::jmp_buf* const outer = m_jump;
    std::jmp_buf here;
    if (setjmp(here) == 0) {
        m_jump = &here;
        function(data, *m_module);
        m_jump = outer;
        return;
    }
    m_jump = outer;
    m_errorDepth = 0;
    if (m_errorCode == Q3_ERR_FATAL) throw DeviceError(m_errorText);
    throw ContentError(m_errorText);
}

void HeadlessEngine::raiseError(int code) {
    m_errorCode = m_errorDepth > 0 ? Q3_ERR_FATAL : code;
    m_errorAtImport = 0;
    if (++m_errorDepth > 2) std::longjmp(*m_jump, 1); // an error inside the clean-up of an error's clean-up
    // The engine's order: the renderer is shut down, and for a drop registered again, while the failing call is live.
    if (m_errorCode == Q3_ERR_FATAL) {
        m_started = false;
        m_module->Shutdown(1);
    } else {
        m_module->Shutdown(0);
        m_module->BeginRegistration(&m_config);
    }
    while (!m_lentFiles.empty()) {
        std::free(m_lentFiles.back());
        m_lentFiles.pop_back();
    }
    std::longjmp(*m_jump, 1);
}

void HeadlessEngine::countImport() {
    if (++m_importCount != m_errorAtImport) return;
    std::snprintf(m_errorText, sizeof m_errorText, "error injected at import %d", m_importCount);
    raiseError(Q3_ERR_DROP);
}

std::string HeadlessEngine::unshownWarnings() const {
    if (m_unshownCount < 2) return m_firstUnshown;
    return m_firstUnshown + formatText(" (and %zu more: --verbose shows them)", m_unshownCount - 1);
}

void HeadlessEngine::raiseErrorAtImport(int number) {
    m_importCount = 0;
    m_errorAtImport = number;
}

std::optional<HostFrame> HeadlessEngine::endFrame(bool capture) {
    if (!capture) {
        enter([](const refexport_t& module) { module.EndFrame(nullptr, nullptr); });
        return std::nullopt;
    }
    const int width = m_config.vidWidth, height = m_config.vidHeight;
    // Sizes of the engine's own video capture; the module may use either buffer as it likes.
    const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
    std::vector<byte> captured(pixels * 4 + 64), encoded(pixels * 4 + 64);
    byte* const captureBytes = captured.data();
    byte* const encodeBytes = encoded.data();
    m_frame = {};
    enter([=](const refexport_t& module) {
        // The OpenGL renderers read the picture before their last run of pictures is drawn: an empty one ends that run.
        module.DrawStretchPic(0, 0, 0, 0, 0, 0, 0, 0, 0);
        module.TakeVideoFrame(width, height, captureBytes, encodeBytes, 0);
        module.EndFrame(nullptr, nullptr);
    });
    if (m_frame.width == 0) throw UsageError(formatText("%s: the module gave no picture", m_modulePath.c_str()));
    return std::move(m_frame);
}

void HeadlessEngine::takeVideoFrame(const byte* bgr, int size) {
    m_frame = frameFromVideo(m_config.vidWidth, m_config.vidHeight, {bgr, static_cast<size_t>(size)});
}

bool HeadlessEngine::runCommand(const std::vector<std::string>& arguments) {
    const auto command = arguments.empty() ? m_commands.end() : m_commands.find(arguments[0]);
    if (command == m_commands.end()) return false;
    m_commandArguments = arguments;
    void (*function)() = command->second;
    enter([function](const refexport_t&) { function(); });
    return true;
}

std::string HeadlessEngine::heldResources() const {
    std::string text;
    if (!m_lentFiles.empty()) text += formatText("%zu files ", m_lentFiles.size());
    if (!m_lentLists.empty()) text += formatText("%zu file lists ", m_lentLists.size());
    for (const auto& [name, function] : m_commands)
        text += "command " + name + " ";
    return text;
}

} // namespace q3rt
