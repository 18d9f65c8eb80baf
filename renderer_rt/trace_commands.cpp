// What the ray tracer adds around the frame: warming and lights at load, the statistics line, radiance to a file.

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/image.hpp"
#include "gpu/device.hpp"
#include "gpu/readback.hpp"
#include "renderer_rt/calibration.hpp"
#include "renderer_rt/prepared_lights.hpp"
#include "renderer_rt/trace_renderer.hpp"

namespace q3rt {

namespace {

constexpr int kStatsIntervalMs = 1000;

/// The engine's commands are plain functions: the one renderer of this module.
TraceRenderer* currentRenderer = nullptr;

} // namespace

void TraceRenderer::addCommands() {
    if (m_commandsAdded) return;
    currentRenderer = this;
    engine().addCommand("screenshotHDR", &TraceRenderer::onScreenshotHdr);
    engine().addCommand("rt_reloadLights", &TraceRenderer::onReloadLights);
    m_commandsAdded = true;
}

void TraceRenderer::removeCommands() {
    if (!m_commandsAdded) return;
    engine().removeCommand("screenshotHDR");
    engine().removeCommand("rt_reloadLights");
    currentRenderer = nullptr;
    m_commandsAdded = false;
}

void TraceRenderer::onReloadLights() {
    if (currentRenderer) currentRenderer->m_reloadLights = true;
}

ModelLightScale TraceRenderer::modelLightScale() const {
    const ViewGeometrySettings scales = viewGeometrySettings();
    return {scales.ambientScale, scales.directedScale};
}

PreparedLights TraceRenderer::loadLights() {
    m_lostLights = m_settings.rt_lostLights;
    m_modelLightScale = modelLightScale();
    m_reloadLights = false;
    return prepareLights(engine(), *world(), materials(), textures(),
                         m_lostLights != 0 ? LightSource::RecoveredOrEstimated : LightSource::Scripts,
                         m_modelLightScale);
}

void TraceRenderer::followLights() {
    const bool changed = m_lostLights != m_settings.rt_lostLights || m_modelLightScale != modelLightScale();
    if (!m_scene->hasWorld() || (!m_reloadLights && !changed)) return;
    const PreparedLights lights = loadLights();
    context().device().waitIdle();
    m_scene->loadLights(lights);
    m_buffers.clear(); // what was seen in other light
    m_lastBuffers = nullptr;
}

void TraceRenderer::onScreenshotHdr() {
    if (!currentRenderer) return;
    const std::vector<std::string> arguments = currentRenderer->engine().commandArguments();
    if (arguments.size() < 2) {
        logLine(LogLevel::Warning,
                "screenshotHDR: give a file name; radiance of the next frame goes to screenshots/NAME.pfm");
        return;
    }
    currentRenderer->m_radianceFile = "screenshots/" + arguments[1] + ".pfm";
}

void TraceRenderer::onGpuFrameEnd() {
    if (!m_radianceFile.empty() && m_lastBuffers && !m_views.empty()) {
        writeRadiance(m_radianceFile);
        m_radianceFile.clear();
    }
    if (m_settings.rt_printPerfStats == kPerformanceLine) printStats();
}

void TraceRenderer::writeRadiance(const std::string& file) {
    const VkExtent2D extent = m_lastBuffers->extent;
    const std::vector<std::byte> bytes = readBuffer(context().device(), m_lastBuffers->radiance);
    std::vector<float> rgb;
    rgb.reserve(size_t{3} * extent.width * extent.height);
    for (size_t i = 0; i < size_t{extent.width} * extent.height; ++i) {
        float texel[4];
        std::memcpy(texel, bytes.data() + i * sizeof(texel), sizeof(texel));
        rgb.insert(rgb.end(), texel, texel + 3);
    }
    engine().writeFile(file, encodePfm(static_cast<int>(extent.width), static_cast<int>(extent.height), rgb));
    if (engine().fileExists(file)) logLine(LogLevel::Info, "wrote %s", file.c_str());
}

void TraceRenderer::printStats() {
    const int now = engine().milliseconds();
    if (now - m_lastPrintMs < kStatsIntervalMs) return;
    m_lastPrintMs = now;
    std::string line = formatText("rt: %s (%s), %u instances, %u moving triangles, %u samples;", backendName(),
                                  m_backendReason.c_str(), m_instanceCount, m_movingTriangleCount,
                                  m_lastBuffers && m_lastBuffers->sums ? m_lastBuffers->sums->sampleNumber + 1 : 1);
    for (const TimerRow& row : context().ring().timers().results())
        line += formatText(" %s %.2f ms", row.name.c_str(), row.ms);
    for (size_t i = 0; i < kStructureClassCount; ++i)
        line += formatText("%s %s %u surfaces %u triangles %u builds %u updates", i == 0 ? ";" : ",",
                           kStructureClassNames[i], m_classCounts[i].surfaces, m_classCounts[i].triangles,
                           m_classCounts[i].builds, m_classCounts[i].updates);
    engine().print(LogLevel::Info, line);
}

/// lavapipe compiles a pipeline at its first dispatch: one frame of a few pixels moves that to the load.
RunTime TraceRenderer::runStill(VkExtent2D extent, bool filters) {
    m_scene->beginFrame();
    FrameCommands frame;
    const SceneView scene = stillOf(*world(), extent);
    m_views.clear();
    ViewBuffers buffers(context().device(), {{0, 0}, extent}, extent);
    const TracedView& view = prepareView(frame, scene, buffers);
    DescriptorArena arena(context().device());
    constexpr ResourceState storageWritten{access::kComputeWrite.stages, access::kComputeWrite.access,
                                           access::kComputeWrite.layout};
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processorStart = std::clock();
    context().device().submitAndWait([&](VkCommandBuffer commands) {
        if (view.top) m_scene->recordBuilds(commands, view);
        StageInput input;
        input.textures = context().textures().set();
        if (view.top)
            input.structures =
                arena.make(m_pipelines->structureLayout(), {bindAccelerationStructure(0, view.top->handle())});
        input.push = {view.frameSlice.address};
        input.extent = extent;
        input.stagedCover = view.stagedCover;
        m_pipelines->warm(commands, input);
        if (!filters) return;
        m_denoisePipelines->warm(commands);
        m_pipelines->warmOtherCover(commands, input);
        context().target().transition(commands, storageWritten);
        m_pictures->warm(commands,
                         arena.make(m_pictures->targetLayout(), {bindStorageImage(0, context().target().view())}));
    });
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    const double processorMs = 1000.0 * static_cast<double>(std::clock() - processorStart) / CLOCKS_PER_SEC;
    m_views.clear();
    m_frameNumber = 0;
    return {taken.count(), processorMs};
}

} // namespace q3rt
