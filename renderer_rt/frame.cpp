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
    ViewResources resources;
    resources.structures = graph.importBuffer("structures", ResourceState{});
    resources.pixels = graph.importBuffer("pixels", buffers.pixels);
    resources.irradiance = graph.importBuffer("irradiance", buffers.irradiance);
    resources.radiance = graph.importBuffer("radiance", buffers.radiance);
    resources.means = graph.importBuffer("means", buffers.means);
    resources.picture = graph.importBuffer("picture", buffers.picture);
    if (buffers.guides) importGuides(graph, resources, *buffers.guides);
    DenoiseResources denoise;
    if (buffers.denoise) denoise = importDenoise(graph, *buffers.denoise);

    if (view.top) addAcceleration(graph, resources, work);
    addPrimary(graph, resources, work);
    if (buffers.denoise) addDenoiseProjection(graph, resources, denoise, describeDenoiseWork(buffers));
    addDirect(graph, resources, work);
    if (buffers.denoise) addDenoise(graph, resources, denoise, describeDenoiseWork(buffers));
    addComposite(graph, resources, work);
    if (buffers.taa)
        addTaa(graph, resources, *buffers.taa, m_taaPipeline, denoise.gradients[kGradientLevels & 1], area->extent);
    addOutput(graph, resources, targets, work, describeOutput(buffers, *area));
}

} // namespace q3rt
