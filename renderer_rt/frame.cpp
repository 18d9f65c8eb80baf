// A traced view, a line a pass.

#include "renderer_rt/trace_renderer.hpp"

namespace q3rt {

void TraceRenderer::drawWorldView(FrameGraph& graph, FrameTargets& targets, const FrameCommands& frame,
                                  const SceneView& scene) {
    const std::optional<VkRect2D> area = visibleArea(scene);
    if (!area || !m_scene->hasWorld()) return;
    m_worldSeen = true;
    ViewBuffers& buffers = buffersOf(*area);
    const TracedView& view = prepareView(frame, scene, buffers);
    const ViewWork work{*m_scene, *m_pipelines, *m_pictures, context(), view, buffers.extent, *area};
    ViewResources resources = importView(graph, buffers);
    beginReport(graph, resources);

    if (m_settings.rt_compare == kCompareRaster)
        raster().addView(graph, targets, frame, scene, drawListSettings(), "compare raster");
    if (view.top) addAcceleration(graph, resources, work);
    if (m_settings.rt_illumination == kPlainIllumination)
        addPlain(graph, resources, work);
    else
        addLitView(graph, resources, work, buffers);
    addOutput(graph, resources, targets, work, describeOutput(buffers, view));

    m_reportBuffer = resources.report;
}

void TraceRenderer::addLitView(FrameGraph& graph, ViewResources& resources, const ViewWork& work,
                               ViewBuffers& buffers) {
    addLook(graph, resources, work);
    addShade(graph, resources, work);
    addPrimary(graph, resources, work);
    if (buffers.denoiser) buffers.denoiser->addBeforeDirect(graph, resources);
    if (work.view.frame.lightsPerPixel == 1) {
        addChoose(graph, resources, work);
        addSort(graph, resources, work);
        addShadows(graph, resources, work);
    } else {
        addDirect(graph, resources, work);
    }
    if (buffers.denoiser) buffers.denoiser->addAfterDirect(graph, resources);
    if (buffers.exposure) addExposureAdapt(graph, resources, work, m_exposureStep);
    if (!m_settings.rt_accumulate) addComposite(graph, resources, work);
    if (buffers.sums) addAccumulate(graph, resources, work);
    if (buffers.exposure) addExposureCount(graph, resources, work);
    if (buffers.taa) addTaa(graph, resources, work, *buffers.taa);
}

} // namespace q3rt
