#pragma once
// The ray tracer as a renderer: world views are traced; 2D, HUD scenes and the window are the rasteriser's.

#include <list>

#include "base/measured_rounds.hpp"
#include "renderer_rt/denoise_pipelines.hpp"
#include "renderer_rt/frame_report.hpp"
#include "renderer_rt/pace.hpp"
#include "renderer_rt/passes/taa.hpp"
#include "renderer_rt/trace_settings.hpp"
#include "renderer_vk/gpu_renderer.hpp"

namespace q3rt {

/// Values of rt_printPerfStats.
inline constexpr int kPerformanceLine = 1, kPerformanceOverlay = 2;

/// A value of rt_illumination.
inline constexpr int kPlainIllumination = 2;

/// Values of rt_compare.
inline constexpr int kCompareRaster = 1, kCompareAccumulated = 2;

class TraceRenderer final : public GpuRenderer {
  public:
    explicit TraceRenderer(EngineServices& engine);
    ~TraceRenderer() override;

  private:
    void drawWorldView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame,
                       const SceneView& scene) override;
    void addLitView(FrameGraph& graph, ViewResources& resources, const ViewWork& work, ViewBuffers& buffers);
    const char* backendName() const override;
    bool isRasterizer() const override { return false; } // light is measured with white as 1
    const char* rendererName() const override { return "q3rt renderer_rt"; }
    void onDeviceCreated() override;
    void onGpuWorldLoaded() override;
    void onGpuReady() override;
    void onGpuContentDropped() override;
    void onGpuFrameBegin(const FrameCommands& frame) override;
    void onGpuFrameEnd() override;
    void addFrameEnd(FrameGraph& graph, FrameTargets& targets, bool captured) override;
    std::string extraStats() const override;

    const TracedView& prepareView(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers);
    /// What the mean of plain samples and automatic exposure need.
    void preparePicture(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers, RtFrame& out);
    /// Turns the view's histories and makes the tables of the denoiser and of temporal anti-aliasing, if they are on.
    void prepareHistory(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers, RtFrame& out);
    void advanceMotion(const FrameCommands& frame, const SceneView& scene, ViewBuffers& buffers, RtFrame& out);
    void describeView(const SceneView& scene, const ViewBuffers& buffers, RtFrame& out) const;
    void describeSettings(RtFrame& out) const;
    bool accumulates() const;
    bool countsRays() const;
    /// All that a view's picture depends on: equal keys, equal expected pictures.
    std::vector<uint32_t> viewKey(const FrameCommands& frame, const SceneView& scene) const;
    /// What changes the light of a view that stays the same: histories end. Levels of rt_targetMs change noise and what
    /// distant mirrors show: histories go on.
    std::vector<uint32_t> settingsKey() const;
    /// rt_scale of what is shown.
    VkExtent2D tracedExtent(VkExtent2D shown) const;
    /// Buffers of a view there that this picture doesn't use yet.
    ViewBuffers& buffersOf(const VkRect2D& area);
    void dropUnusedBuffers();
    /// The part of the view's rectangle that lies on the target.
    std::optional<VkRect2D> visibleArea(const SceneView& scene);
    RtOutput describeOutput(const ViewBuffers& buffers, const TracedView& view) const;
    /// Lets the view's passes count, if anyone wants to know in this frame.
    void beginReport(FrameGraph& graph, ViewResources& resources);
    /// rt_pause and rt_accumulate stop the game.
    void followPause();
    void pauseGame(bool paused);
    void registerOverlayFont();
    /// Numbers over the picture, if they are wanted.
    void addOverlay(FrameGraph& graph, FrameTargets& targets, bool captured);
    std::vector<std::string> performanceLines();
    /// Of a frame whose stages that trace took so long.
    std::string rayLine(double tracingMs) const;
    /// Of a mean of plain samples: how many there are, and how far it is from the truth.
    std::vector<std::string> meanLines() const;
    void addCommands();
    void removeCommands();
    /// The map's lights, with its file of lost ones if they are wanted.
    PreparedLights loadLights();
    ModelLightScale modelLightScale() const;
    /// rt_reloadLights, and changes of rt_lostLights and of the light grid's scales.
    void followLights();
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
    static void onReloadLights();

    TraceSettings m_settings; ///< as the cvars say at a frame's start, then as rt_preset and rt_targetMs make them
    Pace m_pace;
    std::unique_ptr<StagePipelines> m_pipelines;
    std::unique_ptr<PicturePipelines> m_pictures;
    std::unique_ptr<DenoisePipelines> m_denoisePipelines;
    std::unique_ptr<TracedScene> m_scene;
    std::list<ViewBuffers> m_buffers; ///< addresses stay
    std::list<TracedView> m_views;    ///< of this frame; passes refer to them
    ViewGeometry m_geometry;
    ViewBuffers* m_lastBuffers = nullptr;
    bool m_commandsAdded = false;
    // Of the lights that are loaded:
    int m_lostLights = 0; ///< rt_lostLights
    ModelLightScale m_modelLightScale;
    std::optional<PreparedLights> m_preparedLights; ///< while the map is loaded: back ends may be compared
    bool m_reloadLights = false;
    std::string m_calibrationKey; ///< not empty: the back end is to be measured when a map is there
    std::string m_backendReason;
    uint32_t m_pictureNumber = 0; ///< of drawn frames since registration ended
    uint32_t m_frameNumber = 0;   ///< of traced views since the map was loaded
    std::unique_ptr<FrameReport> m_report;
    BufferId m_reportBuffer;            ///< of this frame's graph, from the first view that has a report on
    std::optional<FiniteCheck> m_check; ///< rt_checkFinite
    ExposureStep m_exposureStep;        ///< of the view being prepared
    bool m_worldSeen = false;           ///< in the last frame
    bool m_paused = false;              ///< by us
    int m_overlayFont = 0;              ///< shader; 0: the game has none
    std::string m_radianceFile;         ///< asked for by screenshotHDR
    int m_lastPrintMs = 0;
    uint32_t m_movingTriangleCount = 0, m_instanceCount = 0;
    ClassCounts m_classCounts{}; ///< of the last traced view
};

} // namespace q3rt
