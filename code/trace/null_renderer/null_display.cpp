#include "trace/null_renderer/null_display.hpp"

#include <dlfcn.h>

#include "base/error.hpp"
#include "engine/video_sizes.hpp"

namespace q3rt {
namespace {

/// SDL_INIT_VIDEO and SDL_WINDOW_HIDDEN of SDL 2.
constexpr uint32_t kSdlVideo = 0x20, kSdlHidden = 0x8;

using Size = std::pair<int, int>; ///< pixels
constexpr size_t kDefaultMode = 3;

Size chosenSize(EngineServices& engine) {
    const int flags = cvarFlag::kArchive | cvarFlag::kLatch;
    const int mode = engine.cvar("r_mode", "3", flags).integer();
    const Size custom = {engine.cvar("r_customwidth", "1600", flags).integer(),
                         engine.cvar("r_customheight", "1024", flags).integer()};
    if (mode == -1 && custom.first > 0 && custom.second > 0) return custom;
    return mode >= 0 && mode < static_cast<int>(kVideoSizes.size()) ? kVideoSizes[static_cast<size_t>(mode)]
                                                                    : kVideoSizes[kDefaultMode];
}

} // namespace

template <class Function>
Function* NullDisplay::find(const char* name) {
    void* symbol = dlsym(m_library, name);
    if (!symbol)
        throw DeviceError(formatText("libSDL2-2.0.so.0 has no function %s: install the package libsdl2-2.0-0", name));
    return reinterpret_cast<Function*>(symbol);
}

DisplayInfo NullDisplay::open() {
    const Size size = chosenSize(m_engine);
    if (m_engine.wantsWindow() && !m_window) openWindow(size.first, size.second);
    DisplayInfo display;
    display.rendererText = "no picture";
    display.vendorText = "q3rt";
    display.versionText = "1.0";
    display.maxTextureSize = 16384;
    display.width = size.first;
    display.height = size.second;
    display.aspect = static_cast<float>(size.first) / static_cast<float>(size.second);
    return display;
}

void NullDisplay::openWindow(int width, int height) {
    if (!m_library) m_library = dlopen("libSDL2-2.0.so.0", RTLD_NOW | RTLD_LOCAL);
    if (!m_library) throw DeviceError("libSDL2-2.0.so.0 can't be loaded: install the package libsdl2-2.0-0");
    if (find<int(uint32_t)>("SDL_InitSubSystem")(kSdlVideo) != 0)
        throw DeviceError(formatText("no window: %s", find<const char*()>("SDL_GetError")()));
    m_engine.cvar("r_sdlDriver", find<const char*()>("SDL_GetCurrentVideoDriver")(), cvarFlag::kReadOnly);
    m_engine.cvar("r_availableModes", "", cvarFlag::kReadOnly);
    constexpr int kAnywhere = 0x1FFF0000;
    m_window = find<void*(const char*, int, int, int, int, uint32_t)>("SDL_CreateWindow")("q3rt", kAnywhere, kAnywhere,
                                                                                          width, height, kSdlHidden);
    if (!m_window) throw DeviceError(formatText("no window: %s", find<const char*()>("SDL_GetError")()));
    m_engine.inputInit(m_window);
}

NullDisplay::~NullDisplay() {
    if (m_window) {
        m_engine.inputShutdown();
        find<void(void*)>("SDL_DestroyWindow")(m_window);
        find<void(uint32_t)>("SDL_QuitSubSystem")(kSdlVideo);
    }
    if (m_library) dlclose(m_library);
}

} // namespace q3rt
