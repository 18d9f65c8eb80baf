#pragma once
// The ray tracer as a renderer: world views are traced; 2D, HUD scenes and the window are the rasteriser's.

#include <list>

#include "base/measured_rounds.hpp"
#include "renderer_rt/passes/denoise.hpp"
#include "renderer_rt/passes/taa.hpp"
#include "renderer_rt/trace_settings.hpp"
#include "renderer_vk/gpu_renderer.hpp"

namespace q3rt {

class TraceRenderer final : public GpuRenderer {
  public:
    explicit TraceRenderer(EngineServices& engine);
    ~TraceRenderer() override;

  private:
    void drawWorldView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame,
                       const SceneView& scene) override;
    const char* backendName() const override;
    const char* rendererName() const override { return "q3rt renderer_rt"; }
    void onDeviceCreated() override;
    void onGpuWorldLoaded() override;
    void onGpuReady() override;
    void onGpuContentDropped() override;
    void onGpuFrameBegin(const FrameCommands& frame) override;
    void onGpuFrameEnd() override;
    std::string extraStats() const override;

    const TracedView& prepareView(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers);
    /// Turns the view's histories and makes the tables of the denoiser and of temporal anti-aliasing, if they are on.
    void prepareHistory(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers, RtFrame& out);
    void describeView(const SceneView& scene, VkExtent2D extent, RtFrame& out) const;
    void describeSettings(RtFrame& out) const;
    /// Number of this sample in the mean of an unchanged view; 0 starts a new mean.
    uint32_t countSample(const FrameCommands& frame, const SceneView& scene);
    /// All that a view's picture depends on: equal keys, equal expected pictures.
    std::vector<uint32_t> viewKey(const FrameCommands& frame, const SceneView& scene) const;
    /// What changes the light of a view that stays the same.
    std::vector<uint32_t> settingsKey() const;
    /// Buffers of a view there that this picture doesn't use yet.
    ViewBuffers& buffersOf(const VkRect2D& area);
    void dropUnusedBuffers();
    /// The part of the view's rectangle that lies on the target.
    std::optional<VkRect2D> visibleArea(const SceneView& scene);
    RtOutput describeOutput(const ViewBuffers& buffers, const VkRect2D& area) const;
    void addScreenshotCommand();
    void removeScreenshotCommand();
    void warmPipelines() { runStill({8, 8}, true); }
    /// Draws a still of the map that nobody sees, with the filters or without; times from submission to the end.
    RunTime runStill(VkExtent2D extent, bool filters);
    void useBackend(Backend backend);
    void loadScene(TracedScene& scene);
    /// Measures every back end of the device on the loaded map, and takes and keeps the fastest.
    void calibrate();
    void printStats();
    void writeRadiance(const std::string& file);
    static void onScreenshotHdr();

    TraceSettings m_settings;
    std::unique_ptr<StagePipelines> m_pipelines;
    std::unique_ptr<DenoisePipelines> m_denoisePipelines; ///< made when the denoiser is first wanted
    ComputePipeline m_taaPipeline;                        ///< made when anti-aliasing is first wanted
    std::unique_ptr<TracedScene> m_scene;
    std::list<ViewBuffers> m_buffers; ///< addresses stay
    std::list<TracedView> m_views;    ///< of this frame; passes refer to them
    ViewGeometry m_geometry;
    ViewBuffers* m_lastBuffers = nullptr;
    bool m_commandAdded = false;
    std::string m_calibrationKey; ///< not empty: the back end is to be measured when a map is there
    std::string m_backendReason;
    uint32_t m_pictureNumber = 0; ///< of drawn frames since registration ended
    uint32_t m_frameNumber = 0;   ///< of traced views since the map was loaded
    uint32_t m_sampleNumber = 0;
    std::vector<uint32_t> m_lastViewKey; ///< of the view that the mean belongs to
    std::string m_radianceFile;          ///< asked for by screenshotHDR
    int m_lastPrintMs = 0;
    uint32_t m_movingTriangleCount = 0, m_instanceCount = 0;
    ClassCounts m_classCounts{}; ///< of the last traced view
};

} // namespace q3rt
