#pragma once
// The denoiser's passes, between primary and composite, on L alone (albedo divided out). docs/denoising.md says what
// each does; a denoiser of another kind stands beside these two functions.

#include "renderer_rt/denoise_pipelines.hpp"
#include "renderer_rt/passes/passes.hpp"
#include "renderer_rt/view_buffers.hpp"

namespace q3rt {

/// The graph's handles of the denoiser's buffers, in their newest versions.
struct DenoiseResources {
    BufferId previousPixels, previousIrradiance;
    BufferId light, previousLight;
    BufferId moments, previousMoments;
    BufferId winners;
    BufferId gradients[2];
    BufferId filtered[2];
};

struct DenoiseWork {
    const DenoisePipelines& pipelines;
    VkDeviceAddress table = 0; ///< RtDenoise
    VkExtent2D extent{};       ///< pixels
    bool hasHistory = false;   ///< the frame continues the one before
};

DenoiseResources importDenoise(FrameGraph& graph, DenoiseBuffers& buffers);

/// Before "direct": samples of the last frame find their pixels in this one. "denoise clear", "denoise project",
/// "denoise carry".
void addDenoiseProjection(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                          const DenoiseWork& work);
/// After "direct": from traced light to what the picture shows, resources.lighting. The following four in order.
void addDenoise(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise, const DenoiseWork& work);

/// "denoise gradient", "denoise gradient filter".
void addDenoiseGradient(FrameGraph& graph, const ViewResources& resources, DenoiseResources& denoise,
                        const DenoiseWork& work);
/// "denoise temporal".
void addDenoiseTemporal(FrameGraph& graph, const ViewResources& resources, DenoiseResources& denoise,
                        const DenoiseWork& work);
/// "denoise variance".
void addDenoiseVariance(FrameGraph& graph, const ViewResources& resources, DenoiseResources& denoise,
                        const DenoiseWork& work);
/// "denoise filter".
void addDenoiseFilter(FrameGraph& graph, const ViewResources& resources, DenoiseResources& denoise,
                      const DenoiseWork& work);

} // namespace q3rt
