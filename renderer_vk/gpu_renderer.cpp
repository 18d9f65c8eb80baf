#include "renderer_vk/gpu_renderer.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/text_case.hpp"
#include "gpu/device.hpp"
#include "renderer_vk/anaglyph.hpp"

namespace q3rt {

GpuRenderer::GpuRenderer(EngineServices& engine)
    : FrontEnd(engine) {
    bindRasterSettings(settingsBinding(), m_rasterSettings);
}

GpuRenderer::~GpuRenderer() {
    if (m_context) m_context->device().waitIdle();
    m_raster.reset();
    m_anaglyph.reset();
    m_stages.reset();
}

DisplayInfo GpuRenderer::openDisplay() {
    if (!m_context) {
        auto context = std::make_unique<GpuContext>(engine(), m_rasterSettings, isRasterizer());
        m_raster = std::make_unique<RasterScene>(*context);
        m_anaglyph = std::make_unique<Anaglyph>(*context);
        m_context = std::move(context);
        if (m_rasterSettings.r_stereoEnabled != 0)
            logLine(LogLevel::Warning, "r_stereoEnabled: Vulkan's windows have no stereo; r_anaglyphMode has");
        onDeviceCreated();
    }
    DisplayInfo info = m_context->displayInfo();
    info.rendererText = formatText("%s (%s) on %s", rendererName(), backendName(), info.rendererText.c_str());
    return info;
}

void GpuRenderer::onContentCreated() {
    m_stages = std::make_unique<StageTable>(materials(), textures(), identityLight());
    m_raster->setContent(materials(), models(), *m_stages, settings().r_greyscale);
    m_projectionShadow = knownMaterial("projectionShadow");
    m_sun = knownMaterial("sun");
    m_flare = knownMaterial("flareShader");
}

/// The default material if no script has that name.
MaterialId GpuRenderer::knownMaterial(const char* name) {
    return materials().scripts().find(toLowerAscii(name)) ? materials().find(name, lightmapContext::kNone) : 0;
}

void GpuRenderer::followTextures(bool flush) {
    const float anisotropy = m_rasterSettings.r_ext_texture_filter_anisotropic != 0
                                 ? static_cast<float>(m_rasterSettings.r_ext_max_anisotropy)
                                 : 1.0f;
    m_textureFilter.mode = m_rasterSettings.r_textureMode;
    m_textureFilter.anisotropy = anisotropy;
    m_context->textures().follow(textures(), m_textureFilter, readsTexels(), m_context->uploader());
    if (!m_context->uploader().pending()) return;
    if (flush)
        m_context->uploader().flush();
    else
        m_context->uploader().record(m_context->ring().commands());
}

void GpuRenderer::onWorldLoaded() {
    m_raster->setWorld(world());
    followTextures(true);
    onGpuWorldLoaded();
}

void GpuRenderer::onEndRegistration() {
    followTextures(true);
    m_raster->warmPipelines(m_flare, m_sun);
    onGpuReady();
}

void GpuRenderer::onContentDropped() {
    if (!m_context) return;
    m_context->abandonFrame();
    m_context->device().waitIdle();
    onGpuContentDropped();
    m_raster->dropContent();
    m_stages.reset();
    m_context->textures().reset();
}

void GpuRenderer::followSettings() {
    DrawListSettings& result = m_drawListSettings;
    result.raster = m_rasterSettings;
    result.geometry = viewGeometrySettings();
    constexpr int kVolumes = 2, kProjected = 3;
    if (settings().cg_shadows == kVolumes) result.geometry.shadows = Shadows::Volume;
    if (settings().cg_shadows == kProjected) result.geometry.shadows = Shadows::Projected;
    result.geometry.projectionShadow = m_projectionShadow;
    result.sun = m_sun;
    result.flare = m_flare;
    result.fastSky = settings().r_fastsky != 0;
    result.drawWorld = settings().r_drawworld != 0;
    const RasterSettings& r = m_rasterSettings;
    if (r.r_logFile != 0 || r.r_verbose != 0)
        logLineOnce(LogLevel::Warning,
                    "r_logFile and r_verbose do nothing, as in the original: Q3RT_VALIDATION=1 in the "
                    "environment has each call of Vulkan checked, developer 1 tells more");
    const int wanted = m_context->device().capabilities().software ? 1 : 2; // the setting from which on it is done
    result.textureParts = m_context->textures().parts();
    result.cullTriangles = r.r_cullTriangles >= wanted && r.r_nocull == 0 && r.r_showtris == 0 && r.r_shownormals == 0;
}

void GpuRenderer::onFrame(const FrameCommands& frame, FrameImage* capture) {
    m_context->followWindow(m_rasterSettings);
    m_context->ramp().follow(displayRamp());
    try {
        drawFrame(frame, capture);
    } catch (...) {
        m_raster->abandonFrame();
        m_context->abandonFrame();
        throw;
    }
    if (const int kind = m_rasterSettings.r_speeds; kind != 0)
        engine().print(LogLevel::Info, m_raster->describeCounts(kind));
    if (settings().q3rt_wantStats != 0) publishStats();
}

std::vector<TimerRow> GpuRenderer::passTimes() const {
    std::vector<TimerRow> sums;
    for (const TimerRow& row : m_context->ring().timers().results()) {
        const auto found =
            std::find_if(sums.begin(), sums.end(), [&](const TimerRow& sum) { return sum.name == row.name; });
        if (found != sums.end())
            found->ms += row.ms;
        else
            sums.push_back(row);
    }
    return sums;
}

std::vector<std::string> GpuRenderer::displayLines() const {
    const Capabilities& can = m_context->device().capabilities();
    std::vector<std::string> lines = {
        formatText("device: %s, chosen as %s (r_device names another)", can.deviceName.c_str(),
                   m_context->device().choiceReason().c_str()),
        formatText("driver: %s %s", can.driverName.c_str(), can.driverInfo.c_str()),
        formatText("filter: %s, anisotropy %d", m_rasterSettings.r_textureMode.c_str(),
                   m_rasterSettings.r_ext_texture_filter_anisotropic != 0 ? m_rasterSettings.r_ext_max_anisotropy : 1),
        formatText("device memory: %.1f MiB in use",
                   static_cast<double>(m_context->device().memory().measureUse().usedBytes) / (1 << 20))};
    const VkExtent2D world = m_context->scaledWorld() ? m_context->scaledWorld()->color.extent() : m_context->extent();
    lines.push_back(formatText("world: drawn with %ux%u pixels, %d samples each", world.width, world.height,
                               static_cast<int>(m_context->samples())));
    lines.push_back("shown: " + m_context->describePresentation());
    return lines;
}

void GpuRenderer::publishStats() {
    double total = 0;
    std::string passes;
    for (const TimerRow& pass : passTimes()) {
        total += pass.ms;
        passes += formatText("%s\"%s\":%.4f", passes.empty() ? "" : ",", pass.name.c_str(), pass.ms);
    }
    constexpr double kMiB = 1 << 20;
    const double memoryMib = static_cast<double>(m_context->device().memory().measureUse().usedBytes) / kMiB;
    engine().setCvar(
        "q3rt_stats",
        formatText("{\"gpu_ms\":%.4f,\"passes\":{%s},\"device\":\"%s\",\"backend\":\"%s\",\"memory_mib\":%.1f%s}",
                   total, passes.c_str(), m_context->device().capabilities().deviceName.c_str(), backendName(),
                   memoryMib, extraStats().c_str()));
}

} // namespace q3rt
