// The frame, a line a pass: what the engine asked for in its order, then the window.

#include "renderer_vk/gpu_renderer.hpp"

#include <algorithm>
#include <optional>

#include "renderer_vk/anaglyph.hpp"

namespace q3rt {

namespace {

bool drawsWorld(const FrameCommand& command) {
    const auto* scene = std::get_if<SceneView>(&command);
    return scene && (scene->flags & viewFlag::kNoWorldModel) == 0;
}

bool startsPass(const FrameCommand& command) {
    return std::holds_alternative<SceneView>(command) || std::holds_alternative<Eye>(command);
}

} // namespace

/// The eyes' pictures share one depth, which goes from the one to the other.
void GpuRenderer::changeEye(FrameGraph& graph, Eye next, FrameTargets& targets, std::optional<FrameTargets>& leftEye) {
    if (!m_anaglyph->enabled()) return;
    if (next == Eye::Left) {
        if (!leftEye) leftEye = m_anaglyph->leftEye(graph, targets);
        leftEye->depth = targets.depth;
    } else if (leftEye) {
        targets.depth = leftEye->depth;
    }
    m_eye = next;
}

void GpuRenderer::drawFrame(const FrameCommands& frame, FrameImage* capture) {
    m_context->ring().timers().enabled = wantsTimes();
    m_context->beginFrame();
    followTextures(false);
    followSettings();
    m_stages->beginFrame();
    m_raster->beginFrame(m_drawListSettings);
    m_eye = Eye::Both;
    m_anaglyph->follow(m_rasterSettings.r_anaglyphMode);
    onGpuFrameBegin(frame);

    FrameGraph graph(&m_context->frameMemory());
    FrameTargets targets = importTargets(graph, m_context->main());
    if (m_rasterSettings.r_clear != 0) m_raster->addClear(graph, targets);
    const std::span<const FrameCommand> commands(frame.commands);
    std::optional<FrameTargets> leftEye;
    for (size_t i = 0; i < commands.size();) {
        FrameTargets& eye = leftEye && m_eye == Eye::Left ? *leftEye : targets;
        if (const auto* scene = std::get_if<SceneView>(&commands[i])) {
            if (drawsWorld(commands[i]))
                drawWorldView(graph, eye, frame, *scene);
            else
                m_raster->addView(graph, eye, frame, *scene, drawListSettings(), "hud scene");
            ++i;
            continue;
        }
        if (const auto* next = std::get_if<Eye>(&commands[i])) {
            changeEye(graph, *next, targets, leftEye);
            ++i;
            continue;
        }
        size_t end = i + 1;
        while (end < commands.size() && !startsPass(commands[end]))
            ++end;
        m_raster->addUi(graph, eye, commands.subspan(i, end - i), frame.clockMs);
        i = end;
    }
    if (leftEye) m_anaglyph->addPass(graph, leftEye->color, targets);
    addFrameEnd(graph, targets, capture != nullptr);
    m_context->addPresent(graph, targets.color);

    m_raster->uploadFrame();
    // In play the next frame is near; a picture of loading may stand for seconds.
    const bool inPlay = std::ranges::any_of(commands, drawsWorld);
    m_context->endFrame(graph, capture, inPlay ? Show::WithNextFrame : Show::AtOnce);
    onGpuFrameEnd();
}

} // namespace q3rt
