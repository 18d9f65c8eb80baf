#pragma once
// Device, window and what every frame of every renderer of ours needs of them: targets, resident textures, capture.

#include <memory>
#include <optional>
#include <string>

#include "base/frame_arena.hpp"
#include "engine/front_end.hpp"
#include "frame/frame_executor.hpp"
#include "gpu/device.hpp"
#include "gpu/frame_ring.hpp"
#include "gpu/gpu_image.hpp"
#include "gpu/swapchain.hpp"
#include "gpu/uploader.hpp"
#include "renderer_vk/display_ramp.hpp"
#include "renderer_vk/raster_settings.hpp"
#include "renderer_vk/texture_store.hpp"

namespace q3rt {

class Window;

inline constexpr VkFormat kTargetFormat = VK_FORMAT_R8G8B8A8_UNORM; ///< the original blends in 8 bits

/// What passes draw into. With several samples a pixel `samples` is drawn to, and `color` holds their means.
struct TargetImages {
    GpuImage color, samples, depth;
};

class GpuContext {
  public:
    /// `rasterizer`: r_ext_multisample and r_renderScale count.
    GpuContext(EngineServices& engine, const RasterSettings& settings, bool rasterizer);
    ~GpuContext();
    GpuContext(const GpuContext&) = delete;
    GpuContext& operator=(const GpuContext&) = delete;

    Device& device() { return *m_device; }
    FrameRing& ring() { return *m_ring; }
    /// Of the frame at hand, from beginFrame() on.
    FrameArena& frameMemory() { return m_frameMemory; }
    FrameExecutor& executor() { return *m_executor; }
    Uploader& uploader() { return *m_uploader; }
    TextureStore& textures() { return *m_textures; }
    VkExtent2D extent() const { return m_extent; } ///< pixels; fixed between registrations
    /// The picture: kept over frames, as the original's back buffer is.
    GpuImage& target() { return m_main.color; }
    TargetImages& main() { return m_main; }
    VkSampleCountFlagBits samples() const { return m_samples; }
    /// Pictures hold blue where their format says red: as the window wants it, so that it takes a plain copy. Only
    /// where a processor draws, which would spend more on exchanging them than on the copy.
    bool blueFirst() const { return m_blueFirst; }
    /// Where the world is drawn if not into the picture itself; null otherwise.
    TargetImages* scaledWorld() { return m_scaledWorld ? &*m_scaledWorld : nullptr; }
    DisplayInfo displayInfo() const;
    /// How frames reach the display, for people.
    std::string describePresentation() const;

    /// Between the finished picture and the window or a capture.
    DisplayRamp& ramp() { return *m_ramp; }
    /// Black. Waits for the device: at loading, or when a setting changes.
    TargetImages makeTargets(VkExtent2D extent, const std::string& name);
    /// Opens the frame's command buffer.
    void beginFrame();
    /// Adds the pass that shows the target in the window; nothing when headless or minimised.
    void addPresent(FrameGraph& graph, ImageId target);
    /// Runs the graph and submits. Fills `capture` if not null (waits for the frame).
    void endFrame(FrameGraph& graph, FrameImage* capture, Show show);
    /// After an error between beginFrame() and endFrame().
    void abandonFrame();
    /// Applies changes of r_fullscreen and the like between frames.
    void followWindow(const RasterSettings& settings);
    void minimize();

  private:
    ImageId addScaling(FrameGraph& graph, ImageId picture, VkExtent2D extent);
    EngineServices& m_engine;
    FrameArena m_frameMemory;
    std::unique_ptr<Window> m_window;
    std::unique_ptr<Device> m_device;
    std::unique_ptr<FrameRing> m_ring;
    std::unique_ptr<FrameExecutor> m_executor;
    std::unique_ptr<Uploader> m_uploader;
    std::unique_ptr<TextureStore> m_textures;
    std::unique_ptr<Swapchain> m_swapchain;
    std::unique_ptr<DisplayRamp> m_ramp;
    TargetImages m_main;
    std::optional<TargetImages> m_scaledWorld;
    VkSampleCountFlagBits m_samples = VK_SAMPLE_COUNT_1_BIT;
    VkExtent2D m_extent{640, 480};
    float m_aspect = 4.0f / 3.0f;
    bool m_fullscreen = false, m_blueFirst = false;
};

} // namespace q3rt
