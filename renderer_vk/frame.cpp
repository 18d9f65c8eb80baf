// The frame, a line a pass: what the engine asked for in its order, then the window.

#include "renderer_vk/gpu_renderer.hpp"

namespace q3rt {

void GpuRenderer::drawFrame(const FrameCommands& frame, FrameImage* capture) {
    m_context->ring().timers().enabled = wantsTimes();
    m_context->beginFrame();
    followTextures(false);
    m_stages->beginFrame();
    m_raster->beginFrame(m_rasterSettings);
    onGpuFrameBegin(frame);

    FrameGraph graph;
    FrameTargets targets{graph.importImage("target", m_context->target()),
                         graph.importImage("depth", m_context->depth())};
    if (m_rasterSettings.r_clear != 0) m_raster->addClear(graph, targets);
    const std::span<const FrameCommand> commands(frame.commands);
    for (size_t i = 0; i < commands.size();) {
        if (const auto* scene = std::get_if<SceneView>(&commands[i])) {
            if (scene->flags & viewFlag::kNoWorldModel)
                m_raster->addView(graph, targets, frame, *scene, drawListSettings(), "hud scene");
            else
                drawWorldView(graph, targets, frame, *scene);
            ++i;
            continue;
        }
        size_t end = i + 1;
        while (end < commands.size() && !std::holds_alternative<SceneView>(commands[end]))
            ++end;
        m_raster->addUi(graph, targets, commands.subspan(i, end - i), frame.clockMs);
        i = end;
    }
    addFrameEnd(graph, targets, capture != nullptr);
    m_context->addPresent(graph, targets.color);

    m_raster->uploadFrame();
    m_context->endFrame(graph, capture);
    onGpuFrameEnd();
}

} // namespace q3rt
