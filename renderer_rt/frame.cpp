// A traced view, a line a pass.

#include "renderer_rt/trace_renderer.hpp"

namespace q3rt {

void TraceRenderer::drawWorldView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame,
                                  const SceneView& scene) {
    const std::optional<VkRect2D> area = visibleArea(scene);
    if (!area || !m_scene->hasWorld()) return;
    ViewBuffers& buffers = buffersOf(*area);
    const TracedView& view = prepareView(frame, scene, buffers);
    const ViewWork work{*m_scene, *m_pipelines, context(), view, area->extent};
    ViewResources resources = importView(graph, buffers);

    if (view.top) addAcceleration(graph, resources, work);
    addPrimary(graph, resources, work);
    if (buffers.denoiser) buffers.denoiser->addBeforeDirect(graph, resources);
    addDirect(graph, resources, work);
    if (buffers.denoiser) buffers.denoiser->addAfterDirect(graph, resources);
    addComposite(graph, resources, work);
    if (buffers.taa) addTaa(graph, resources, *buffers.taa, m_taaPipeline, area->extent);
    addOutput(graph, resources, targets, work, describeOutput(buffers, *area));
}

} // namespace q3rt
