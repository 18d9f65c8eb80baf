#include "renderer_vk/window.hpp"

#include <algorithm>
#include <cstring>
#include <dlfcn.h>

#include <SDL.h>
#include <SDL_vulkan.h>

#include "base/error.hpp"
#include "base/log.hpp"

namespace q3rt {

/// Entry points of the SDL library, by name.
struct Window::Sdl {
    void* library = nullptr;
    decltype(&SDL_InitSubSystem) initSubSystem;
    decltype(&SDL_QuitSubSystem) quitSubSystem;
    decltype(&SDL_WasInit) wasInit;
    decltype(&SDL_GetError) getError;
    decltype(&SDL_GetCurrentVideoDriver) getCurrentVideoDriver;
    decltype(&SDL_CreateWindow) createWindow;
    decltype(&SDL_DestroyWindow) destroyWindow;
    decltype(&SDL_SetWindowFullscreen) setWindowFullscreen;
    decltype(&SDL_MinimizeWindow) minimizeWindow;
    decltype(&SDL_GetNumVideoDisplays) getNumVideoDisplays;
    decltype(&SDL_GetWindowDisplayIndex) getWindowDisplayIndex;
    decltype(&SDL_GetDesktopDisplayMode) getDesktopDisplayMode;
    decltype(&SDL_GetNumDisplayModes) getNumDisplayModes;
    decltype(&SDL_GetDisplayMode) getDisplayMode;
    decltype(&SDL_GetWindowDisplayMode) getWindowDisplayMode;
    decltype(&SDL_SetWindowDisplayMode) setWindowDisplayMode;
    decltype(&SDL_Vulkan_GetInstanceExtensions) getInstanceExtensions;
    decltype(&SDL_Vulkan_CreateSurface) createSurface;
    decltype(&SDL_Vulkan_GetDrawableSize) getDrawableSize;

    template <typename Function>
    void load(Function& target, const char* name) {
        target = reinterpret_cast<Function>(dlsym(library, name));
        if (!target) throw DeviceError(formatText("libSDL2-2.0.so.0 lacks %s: install a newer libsdl2-2.0-0", name));
    }
    Sdl() {
        library = dlopen("libSDL2-2.0.so.0", RTLD_NOW | RTLD_LOCAL);
        if (!library) throw DeviceError("libSDL2-2.0.so.0 not found: install libsdl2-2.0-0 to open a window");
        load(initSubSystem, "SDL_InitSubSystem");
        load(quitSubSystem, "SDL_QuitSubSystem");
        load(wasInit, "SDL_WasInit");
        load(getError, "SDL_GetError");
        load(getCurrentVideoDriver, "SDL_GetCurrentVideoDriver");
        load(createWindow, "SDL_CreateWindow");
        load(destroyWindow, "SDL_DestroyWindow");
        load(setWindowFullscreen, "SDL_SetWindowFullscreen");
        load(minimizeWindow, "SDL_MinimizeWindow");
        load(getNumVideoDisplays, "SDL_GetNumVideoDisplays");
        load(getWindowDisplayIndex, "SDL_GetWindowDisplayIndex");
        load(getDesktopDisplayMode, "SDL_GetDesktopDisplayMode");
        load(getNumDisplayModes, "SDL_GetNumDisplayModes");
        load(getDisplayMode, "SDL_GetDisplayMode");
        load(getWindowDisplayMode, "SDL_GetWindowDisplayMode");
        load(setWindowDisplayMode, "SDL_SetWindowDisplayMode");
        load(getInstanceExtensions, "SDL_Vulkan_GetInstanceExtensions");
        load(createSurface, "SDL_Vulkan_CreateSurface");
        load(getDrawableSize, "SDL_Vulkan_GetDrawableSize");
    }
    ~Sdl() {
        if (library) dlclose(library);
    }
};

namespace {

SDL_Window* asSdl(void* window) { return static_cast<SDL_Window*>(window); }

constexpr size_t kModeListLimit = 1023; // characters of r_availableModes that the engine's menus read

} // namespace

Window::Window(EngineServices& engine, const RasterSettings& settings)
    : m_engine(engine)
    , m_sdl(std::make_unique<Sdl>()) {
    openVideo();
    chooseDisplay(settings.r_display);
    try {
        openWindow(settings);
    } catch (...) {
        m_sdl->quitSubSystem(SDL_INIT_VIDEO);
        throw;
    }
    publishModes(settings);
    m_engine.inputInit(m_window);
}

Window::~Window() {
    m_engine.inputShutdown();
    if (m_window) m_sdl->destroyWindow(asSdl(m_window));
    m_sdl->quitSubSystem(SDL_INIT_VIDEO);
}

void Window::openVideo() {
    if (m_sdl->initSubSystem(SDL_INIT_VIDEO) != 0)
        throw DeviceError(formatText(
            "SDL video did not start (%s): set SDL_VIDEODRIVER=dummy to play without a display", m_sdl->getError()));
    const char* driver = m_sdl->getCurrentVideoDriver();
    const std::string name = driver ? driver : "";
    m_presents = name != "dummy" && name != "offscreen";
    m_engine.cvar("r_sdlDriver", name, cvarFlag::kReadOnly);
}

void Window::chooseDisplay(int wanted) {
    const int count = m_sdl->getNumVideoDisplays();
    m_wantedDisplay = wanted < count ? wanted : 0;
    if (m_wantedDisplay != wanted)
        logLine(LogLevel::Warning, "r_display %d: there is no such display, only 0 to %d; using 0", wanted,
                std::max(count, 1) - 1);
}

int Window::display() const { return std::max(m_sdl->getWindowDisplayIndex(asSdl(m_window)), 0); }

std::pair<int, int> Window::desktopSize() const {
    SDL_DisplayMode mode{};
    if (m_sdl->getDesktopDisplayMode(m_wantedDisplay, &mode) != 0 || mode.w <= 0 || mode.h <= 0)
        return {kFallbackMode.width, kFallbackMode.height};
    return {mode.w, mode.h};
}

void Window::openWindow(const RasterSettings& settings) {
    bool fullscreen = settings.r_fullscreen != 0 && m_presents;
    auto mode = findVideoMode(settings, desktopSize());
    if (!mode) {
        logLine(LogLevel::Warning, "r_mode %d does not exist; using 640x480 in a window", settings.r_mode);
        mode = kFallbackMode;
        fullscreen = false;
    }
    const auto onDisplay = static_cast<unsigned>(m_wantedDisplay);
    const auto place = static_cast<int>(settings.r_centerWindow != 0 ? SDL_WINDOWPOS_CENTERED_DISPLAY(onDisplay)
                                                                     : SDL_WINDOWPOS_UNDEFINED_DISPLAY(onDisplay));
    for (int attempt = 0; attempt < 2 && !m_window; ++attempt) {
        Uint32 flags = SDL_WINDOW_SHOWN;
        if (m_presents) flags |= SDL_WINDOW_VULKAN;
        if (fullscreen) flags |= SDL_WINDOW_FULLSCREEN;
        if (settings.r_noborder != 0 && !fullscreen) flags |= SDL_WINDOW_BORDERLESS;
        if (settings.r_allowResize != 0 && !fullscreen) flags |= SDL_WINDOW_RESIZABLE;
        m_window = m_sdl->createWindow("OpenArena", place, place, mode->width, mode->height, flags);
        if (m_window) break;
        fullscreen = false;
        mode = kFallbackMode;
    }
    if (!m_window) throw DeviceError(formatText("no window could be opened (%s)", m_sdl->getError()));
    m_mode = *mode;
    m_fullscreen = fullscreen;
}

void Window::publishModes(const RasterSettings&) {
    std::vector<std::pair<int, int>> sizes;
    const int count = m_sdl->getNumDisplayModes(m_wantedDisplay);
    for (int i = 0; i < count; ++i) {
        SDL_DisplayMode mode{};
        if (m_sdl->getDisplayMode(m_wantedDisplay, i, &mode) == 0) sizes.emplace_back(mode.w, mode.h);
    }
    const auto [width, height] = desktopSize();
    const float desktopAspect = static_cast<float>(width) / static_cast<float>(height);
    std::ranges::sort(sizes, {}, [&](const std::pair<int, int>& size) {
        const float off = std::abs(static_cast<float>(size.first) / static_cast<float>(size.second) - desktopAspect);
        return std::pair(off > 0.001f ? off : 0.0f, size.first * size.second);
    });
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    std::string text;
    for (const auto& [w, h] : sizes) {
        const std::string one = formatText("%s%dx%d", text.empty() ? "" : " ", w, h);
        if (text.size() + one.size() > kModeListLimit) break;
        text += one;
    }
    m_engine.cvar("r_availableModes", "", cvarFlag::kReadOnly);
    if (!text.empty()) m_engine.setCvar("r_availableModes", text);
}

std::vector<std::string> Window::instanceExtensions() const {
    if (!m_presents) return {};
    unsigned count = 0;
    if (!m_sdl->getInstanceExtensions(asSdl(m_window), &count, nullptr)) return {};
    std::vector<const char*> names(count);
    m_sdl->getInstanceExtensions(asSdl(m_window), &count, names.data());
    return {names.begin(), names.end()};
}

VkSurfaceKHR Window::createSurface(VkInstance instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (!m_sdl->createSurface(asSdl(m_window), instance, &surface))
        throw DeviceError(formatText("no Vulkan surface for the window (%s)", m_sdl->getError()));
    return surface;
}

VkExtent2D Window::drawableExtent() const {
    if (!m_presents) return {static_cast<uint32_t>(m_mode.width), static_cast<uint32_t>(m_mode.height)};
    int width = 0, height = 0;
    m_sdl->getDrawableSize(asSdl(m_window), &width, &height);
    return {static_cast<uint32_t>(std::max(width, 0)), static_cast<uint32_t>(std::max(height, 0))};
}

int Window::refreshHz() const {
    SDL_DisplayMode mode{};
    if (!m_fullscreen || m_sdl->getWindowDisplayMode(asSdl(m_window), &mode) != 0) return 0;
    return mode.refresh_rate;
}

bool Window::setFullscreen(bool fullscreen) {
    if (!m_presents || fullscreen == m_fullscreen) return true;
    if (m_sdl->setWindowFullscreen(asSdl(m_window), fullscreen ? Uint32{SDL_WINDOW_FULLSCREEN} : Uint32{0}) != 0)
        return false;
    m_fullscreen = fullscreen;
    m_engine.inputRestart();
    return true;
}

void Window::minimize() { m_sdl->minimizeWindow(asSdl(m_window)); }

} // namespace q3rt
