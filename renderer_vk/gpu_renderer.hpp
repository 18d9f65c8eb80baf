#pragma once
// A renderer with a device: everything that the rasteriser and the ray tracer share. A derived class draws world views;
// 2D, HUD scenes, textures, window and capture are done here.

#include <memory>
#include <optional>

#include "engine/front_end.hpp"
#include "renderer_vk/gpu_context.hpp"
#include "renderer_vk/raster_scene.hpp"
#include "renderer_vk/video_modes.hpp"

namespace q3rt {

class Anaglyph;

class GpuRenderer : public FrontEnd {
  public:
    explicit GpuRenderer(EngineServices& engine);
    ~GpuRenderer() override;

  protected:
    // --- what a derived renderer supplies ---
    /// Adds the passes of one world view (never RDF_NOWORLDMODEL). Read frame buffers through `targets`, replace its
    /// handles by what you wrote. Stages evaluated now through stageTable() are on the GPU when the passes record.
    virtual void drawWorldView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame,
                               const SceneView& scene) = 0;
    /// "raster", "pipeline", "query", "compute": goes into q3rt_stats and the renderer string.
    virtual const char* backendName() const = 0;
    virtual const char* rendererName() const = 0;
    /// Are the pixels of textures read on the CPU after their upload?
    virtual bool readsTexels() const { return true; }
    /// Does anybody look at the times of passes?
    virtual bool wantsTimes() const { return true; }
    /// The device exists (once); make what does not depend on content.
    virtual void onDeviceCreated() {}
    /// A map is loaded; its materials and textures are known, and resident.
    virtual void onGpuWorldLoaded() {}
    /// EndRegistration: create and warm all pipelines.
    virtual void onGpuReady() {}
    /// Content goes: drop what refers to it. The GPU is idle. Legal at any moment.
    virtual void onGpuContentDropped() {}
    /// Start of a frame, before any view: the command buffer is open, textures are up to date.
    virtual void onGpuFrameBegin(const FrameCommands&) {}
    /// After all views and 2D, before the window: the last passes. `captured`: the picture is kept by somebody.
    virtual void addFrameEnd(FrameGraph&, FrameTargets&, bool /*captured*/) {}
    /// The frame was submitted.
    virtual void onGpuFrameEnd() {}
    /// More members of q3rt_stats, as JSON text beginning with a comma, or empty.
    virtual std::string extraStats() const { return {}; }

    GpuContext& context() { return *m_context; }
    RasterScene& raster() { return *m_raster; }
    StageTable& stageTable() { return *m_stages; }
    const RasterSettings& rasterSettings() const { return m_rasterSettings; }
    /// Of the frame at hand.
    const DrawListSettings& drawListSettings() const { return m_drawListSettings; }
    /// Milliseconds of each pass of the newest finished frame; a pass may come more than once: its times add up.
    std::vector<TimerRow> passTimes() const;
    /// True once the first registration has opened the device.
    bool hasDevice() const { return m_context != nullptr; }

  private:
    DisplayInfo openDisplay() final;
    void onContentCreated() final;
    void onWorldLoaded() final;
    void onEndRegistration() final;
    void onFrame(const FrameCommands& frame, FrameImage* capture) final;
    void onContentDropped() final;
    void onMinimize() final { m_context->minimize(); }
    std::vector<std::string> modeLines() const final { return describeVideoModes(m_rasterSettings); }
    std::vector<std::string> displayLines() const final;
    void drawFrame(const FrameCommands& frame, FrameImage* capture);
    void changeEye(FrameGraph& graph, Eye next, FrameTargets& targets, std::optional<FrameTargets>& leftEye);
    void followTextures(bool flush);
    void followSettings();
    MaterialId knownMaterial(const char* name);
    void publishStats();

    RasterSettings m_rasterSettings;
    DrawListSettings m_drawListSettings;
    TextureFilter m_textureFilter;
    MaterialId m_projectionShadow = 0, m_sun = 0, m_flare = 0; ///< that the renderer draws of its own
    std::unique_ptr<GpuContext> m_context;
    std::unique_ptr<RasterScene> m_raster;
    std::unique_ptr<StageTable> m_stages;
    std::unique_ptr<Anaglyph> m_anaglyph;
    Eye m_eye = Eye::Both; ///< whose picture is being drawn
};

} // namespace q3rt
