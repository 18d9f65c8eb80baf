#include "renderer_rt/trace_renderer.hpp"

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/measured_choices.hpp"
#include "gpu/device.hpp"
#include "renderer_rt/calibration.hpp"
#include "renderer_rt/presets.hpp"

namespace q3rt {

TraceRenderer::TraceRenderer(EngineServices& engine)
    : GpuRenderer(engine) {
    bindTraceSettings(settingsBinding(), m_settings);
}

TraceRenderer::~TraceRenderer() {
    removeCommands();
    if (hasDevice()) context().device().waitIdle();
}

const char* TraceRenderer::backendName() const {
    return m_pipelines ? nameOf(m_pipelines->backend()) : m_settings.rt_backend.c_str();
}

void TraceRenderer::onDeviceCreated() {
    m_pictures = std::make_unique<PicturePipelines>(context().device());
    m_denoisePipelines = std::make_unique<DenoisePipelines>(context().device());
    m_report = std::make_unique<FrameReport>(context().device(), context().ring().framesInFlight());
    const Capabilities& can = context().device().capabilities();
    Backend backend = chooseBackend(m_settings.rt_backend, can);
    m_backendReason = "as set";
    m_calibrationKey.clear();
    if (m_settings.rt_backend == "auto") {
        const std::string key = calibrationKey(can);
        if (const auto known = findMeasuredChoice(measuredChoicesFile(), key)) {
            backend = chooseBackend(known->choice, can);
            m_backendReason = "measured before: " + known->reason;
        } else {
            m_calibrationKey = key;
        }
    }
    useBackend(backend);
}

void TraceRenderer::useBackend(Backend backend) {
    m_scene.reset();
    m_pipelines = std::make_unique<StagePipelines>(context().device(), backend, context().textures().layout());
    m_scene = std::make_unique<TracedScene>(context(), backend);
}

void TraceRenderer::loadScene(TracedScene& scene) {
    scene.setContent(materials(), textures());
    scene.loadWorld(*world(), *m_preparedLights);
}

void TraceRenderer::onGpuWorldLoaded() {
    registerOverlayFont();
    m_preparedLights.emplace(loadLights());
    loadScene(*m_scene);
    m_frameNumber = 0;
    const StaticGeometry& statics = *m_scene->statics();
    logLine(LogLevel::Info, "%u world triangles in %zu structures (%.1f MiB), %zu triangle lights, %zu others",
            statics.triangleCount(), statics.parts().size(), static_cast<double>(statics.bytes()) / (1 << 20),
            m_scene->lights()->triangleCount(), m_scene->lights()->others().size());
}

void TraceRenderer::onGpuReady() {
    addCommands();
    if (!m_scene->hasWorld()) return;
    m_pace.applyPreset(m_settings);
    if (!m_calibrationKey.empty()) calibrate();
    m_preparedLights.reset();
    if (m_settings.rt_illumination == kPlainIllumination) m_pipelines->requirePlain(context().device());
    warmPipelines();
    // Whatever was drawn while the map was loaded, the first picture of the world is the same.
    m_pictureNumber = 0;
    m_buffers.clear();
    m_lastBuffers = nullptr;
}

void TraceRenderer::onGpuContentDropped() {
    removeCommands();
    if (m_paused) pauseGame(false);
    m_overlayFont = 0;
    m_views.clear();
    m_buffers.clear();
    m_lastBuffers = nullptr;
    if (m_scene) m_scene->dropContent();
}

void TraceRenderer::onGpuFrameBegin(const FrameCommands&) {
    const GpuTimers& timers = context().ring().timers();
    double finishedMs = 0;
    for (const TimerRow& row : timers.results())
        finishedMs += row.ms;
    m_pace.apply(m_settings, context().ring().frameNumber(), timers.resultsFrame(), finishedMs);
    if (m_settings.rt_illumination == kPlainIllumination && !m_pipelines->hasPlain()) {
        logLineOnce(LogLevel::Warning, "rt_illumination 2: seen from vid_restart or the next map on");
        m_settings.rt_illumination = 1;
    }
    // Its picture is a function of the frame alone.
    if (m_settings.rt_illumination == kPlainIllumination)
        applySettings("rt_accumulate 0 rt_autoExposure 0 rt_compare 0 rt_denoiser 0 rt_scale 100 rt_taa 0", m_settings);
    m_views.clear();
    followLights();
    m_scene->beginFrame();
    m_report->beginFrame(context().ring().slot());
    m_reportBuffer = {};
    ++m_pictureNumber;
    dropUnusedBuffers();
    followPause();
}

bool TraceRenderer::countsRays() const { return m_settings.rt_countWork != 0 || m_settings.rt_printPerfStats != 0; }

void TraceRenderer::beginReport(FrameGraph& graph, ViewResources& resources) {
    const bool isRead = settings().q3rt_wantStats || m_settings.rt_printPerfStats || engine().wantsWindow();
    m_check.reset();
    if (m_settings.rt_checkFinite) m_check.emplace(FiniteCheck{*m_report, *m_pictures});
    resources.countsWork = countsRays();
    if (!m_check && !resources.countsWork && !(accumulates() && isRead)) return;
    resources.report = m_reportBuffer ? m_reportBuffer : m_report->addClear(graph);
    resources.check = m_check ? &*m_check : nullptr;
}

void TraceRenderer::addFrameEnd(FrameGraph& graph, FrameTargets& targets, bool captured) {
    addOverlay(graph, targets, captured);
    if (m_reportBuffer) m_report->addCopy(graph, m_reportBuffer);
}

void TraceRenderer::followPause() {
    // Not before a world was seen: a game that stands still while it connects never starts.
    const bool wanted = (m_settings.rt_pause != 0 || m_settings.rt_accumulate != 0) && m_worldSeen;
    m_worldSeen = false;
    if (wanted || m_paused) pauseGame(wanted);
}

void TraceRenderer::pauseGame(bool paused) {
    // The first stops a demo, the second a local game; each does nothing in the other case. The engine's menu takes the
    // pause back when it is left.
    for (const char* name : {"cl_freezeDemo", "cl_paused"})
        engine().setCvar(name, paused ? "1" : "0");
    m_paused = paused;
}

std::string TraceRenderer::extraStats() const {
    std::string text =
        formatText(",\"instances\":%u,\"moving_triangles\":%u,\"lights\":%zu,\"classes\":{", m_instanceCount,
                   m_movingTriangleCount, m_scene && m_scene->hasWorld() ? m_scene->lights()->triangleCount() : 0);
    for (size_t i = 0; i < kStructureClassCount; ++i)
        text += formatText("%s\"%s\":{\"surfaces\":%u,\"triangles\":%u,\"builds\":%u,\"updates\":%u}",
                           i == 0 ? "" : ",", kStructureClassNames[i], m_classCounts[i].surfaces,
                           m_classCounts[i].triangles, m_classCounts[i].builds, m_classCounts[i].updates);
    text += "}";
    if (m_settings.rt_targetMs > 0) text += formatText(",\"level\":%zu", m_pace.level());
    if (m_scene && m_scene->hasWorld()) text += formatText(",\"other_lights\":%zu", m_scene->lights()->others().size());
    if (!m_views.empty()) {
        const uint32_t flags = m_views.back().frame.flags;
        text += formatText(",\"looks_for\":{\"layers\":%d,\"near_entities\":%d,\"several_skies\":%d}",
                           (flags & kFrameLayers) != 0, (flags & kFrameNearEntities) != 0,
                           (flags & kFrameSkySurfaces) != 0);
    }
    const ReportNumbers& report = m_report->latest();
    if (m_lastBuffers)
        text += formatText(",\"history\":%s", m_lastBuffers->guides || m_lastBuffers->exposure ? "true" : "false");
    if (m_lastBuffers && m_lastBuffers->sums)
        text += formatText(",\"samples\":%u", m_lastBuffers->sums->sampleNumber + 1);
    if (report.hasError && m_lastBuffers && m_lastBuffers->sums)
        text += formatText(",\"expected_ssim\":%.6f,\"standard_error\":%.8f", report.likeness, report.error);
    if (countsRays()) text += formatText(",\"rays\":%llu", static_cast<unsigned long long>(report.rayCount));
    if (m_settings.rt_countWork)
        text += formatText(
            ",\"work\":{\"any_hit\":%u,\"layers\":%u,\"turned_rays\":%u,\"sky_looks\":%u,\"lights_tried\":%u}",
            report.work[kWorkAnyHit], report.work[kWorkLayer], report.work[kWorkTurn], report.work[kWorkSky],
            report.work[kWorkLight]);
    if (report.counts.empty()) return text;
    text += ",\"nonfinite\":{";
    for (size_t i = 0; i < report.counts.size(); ++i)
        text += formatText("%s\"%s\":%llu", i == 0 ? "" : ",", report.counts[i].pass.c_str(),
                           static_cast<unsigned long long>(report.counts[i].nonFinite));
    return text + "}";
}

} // namespace q3rt
