#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

ViewResources importView(FrameGraph& graph, ViewBuffers& buffers) {
    ViewResources resources;
    resources.structures = graph.importBuffer("structures", ResourceState{});
    resources.looks = graph.importBuffer("looks", buffers.looks);
    resources.pixels = graph.importBuffer("pixels", buffers.pixels);
    resources.irradiance = graph.importBuffer("irradiance", buffers.irradiance);
    resources.ambient = graph.importBuffer("ambient", buffers.ambient);
    resources.radiance = graph.importBuffer("radiance", buffers.radiance);
    resources.picture = graph.importBuffer("picture", buffers.picture);
    resources.shadowRays = graph.importBuffer("shadow rays", buffers.shadowRays);
    resources.shadowBins = graph.importBuffer("shadow bins", buffers.shadowBins);
    resources.shadowOrder = graph.importBuffer("shadow order", buffers.shadowOrder);
    if (buffers.sums) {
        resources.sums = graph.importBuffer("sums", buffers.sums->sums);
        resources.reference = graph.importBuffer("reference", buffers.sums->reference);
    }
    if (buffers.exposure) resources.exposure = graph.importBuffer("exposure", *buffers.exposure);
    if (buffers.guides) {
        resources.guides = graph.importBuffer("guides", buffers.guides->guides);
        resources.previousGuides = graph.importBuffer("previous guides", buffers.guides->previousGuides);
        resources.pasts = graph.importBuffer("pasts", buffers.guides->pasts);
    }
    if (buffers.denoiser) buffers.denoiser->import(graph);
    return resources;
}

} // namespace q3rt
