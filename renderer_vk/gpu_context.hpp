#pragma once
// Device, window and what every frame of every renderer of ours needs of them: targets, resident textures, capture.

#include <memory>

#include "engine/front_end.hpp"
#include "frame/frame_executor.hpp"
#include "gpu/device.hpp"
#include "gpu/frame_ring.hpp"
#include "gpu/gpu_image.hpp"
#include "gpu/swapchain.hpp"
#include "gpu/uploader.hpp"
#include "renderer_vk/raster_settings.hpp"
#include "renderer_vk/texture_store.hpp"

namespace q3rt {

class Window;

inline constexpr VkFormat kTargetFormat = VK_FORMAT_R8G8B8A8_UNORM; ///< the original blends in 8 bits

class GpuContext {
  public:
    GpuContext(EngineServices& engine, const RasterSettings& settings);
    ~GpuContext();
    GpuContext(const GpuContext&) = delete;
    GpuContext& operator=(const GpuContext&) = delete;

    Device& device() { return *m_device; }
    FrameRing& ring() { return *m_ring; }
    FrameExecutor& executor() { return *m_executor; }
    Uploader& uploader() { return *m_uploader; }
    TextureStore& textures() { return *m_textures; }
    VkExtent2D extent() const { return m_extent; } ///< pixels; fixed between registrations
    /// The picture: kept over frames, as the original's back buffer is.
    GpuImage& target() { return m_target; }
    GpuImage& depth() { return m_depth; }
    DisplayInfo displayInfo() const;

    /// Opens the frame's command buffer.
    void beginFrame();
    /// Adds the pass that shows the target in the window; nothing when headless or minimised.
    void addPresent(FrameGraph& graph, ImageId target);
    /// Runs the graph and submits. Fills `capture` if not null (waits for the frame).
    void endFrame(FrameGraph& graph, FrameImage* capture);
    /// After an error between beginFrame() and endFrame().
    void abandonFrame();
    /// Applies changes of r_fullscreen and the like between frames.
    void followWindow(const RasterSettings& settings);
    void minimize();

  private:
    void createTargets();

    EngineServices& m_engine;
    std::unique_ptr<Window> m_window;
    std::unique_ptr<Device> m_device;
    std::unique_ptr<FrameRing> m_ring;
    std::unique_ptr<FrameExecutor> m_executor;
    std::unique_ptr<Uploader> m_uploader;
    std::unique_ptr<TextureStore> m_textures;
    std::unique_ptr<Swapchain> m_swapchain;
    GpuImage m_target, m_depth;
    VkExtent2D m_extent{640, 480};
    float m_aspect = 4.0f / 3.0f;
    bool m_fullscreen = false;
};

} // namespace q3rt
