#pragma once
// The SDL window. The SDL library is opened at run time, so that a headless machine needs none. With a display the
// window has a Vulkan surface; under SDL's dummy and offscreen drivers it only serves input, and frames stay in images.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/services.hpp"
#include "gpu/vulkan_api.hpp"
#include "renderer_vk/video_modes.hpp"

namespace q3rt {

class Window {
  public:
    /// Opens SDL video and the window. Throws DeviceError.
    Window(EngineServices& engine, const RasterSettings& settings);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Empty: this window can't present.
    std::vector<std::string> instanceExtensions() const;
    VkSurfaceKHR createSurface(VkInstance instance) const;
    bool presents() const { return m_presents; }
    VideoMode mode() const { return m_mode; }
    /// Size of the drawable now, pixels.
    VkExtent2D drawableExtent() const;
    bool fullscreen() const { return m_fullscreen; }
    int refreshHz() const;
    int display() const; ///< number of the one that shows most of it
    /// Returns false if SDL refuses: a restart is needed.
    bool setFullscreen(bool fullscreen);
    void minimize();

  private:
    struct Sdl;
    void openVideo();
    void chooseDisplay(int wanted);
    void openWindow(const RasterSettings& settings);
    void publishModes(const RasterSettings& settings);
    std::pair<int, int> desktopSize() const;
    int m_wantedDisplay = 0;

    EngineServices& m_engine;
    std::unique_ptr<Sdl> m_sdl;
    void* m_window = nullptr; // SDL_Window*
    VideoMode m_mode;
    bool m_presents = false, m_fullscreen = false;
};

} // namespace q3rt
