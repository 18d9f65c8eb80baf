// A traced view, a line a pass.

#include "renderer_rt/trace_renderer.hpp"

namespace q3rt {

void TraceRenderer::drawWorldView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame,
                                  const SceneView& scene) {
    const std::optional<VkRect2D> area = visibleArea(scene);
    if (!area || !m_scene->hasWorld()) return;
    const TracedView& view = prepareView(frame, scene, area->extent);
    ViewBuffers& buffers = buffersOf(area->extent);
    const ViewWork work{*m_scene, *m_pipelines, context(), view, area->extent};
    ViewResources resources{
        graph.importBuffer("structures", ResourceState{}), graph.importBuffer("pixels", buffers.pixels),
        graph.importBuffer("irradiance", buffers.irradiance), graph.importBuffer("radiance", buffers.radiance)};

    if (view.top) addAcceleration(graph, resources, work);
    addPrimary(graph, resources, work);
    addDirect(graph, resources, work);
    addComposite(graph, resources, work);
    addOutput(graph, resources, targets, work, describeOutput(buffers, *area));
}

} // namespace q3rt
