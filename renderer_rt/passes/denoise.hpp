#pragma once
// The passes of SVGF and A-SVGF, on direct light with albedo divided out. docs/denoising.md says what each does.

#include "renderer_rt/denoise_pipelines.hpp"
#include "renderer_rt/passes/passes.hpp"

namespace q3rt {

/// The graph's handles of a denoiser's buffers, in their newest versions.
struct DenoiseResources {
    BufferId light, previousLight;
    BufferId moments, previousMoments;
    BufferId filtered[2];
    BufferId previousPixels, previousIrradiance; ///< A-SVGF, and what follows
    BufferId winners;
    BufferId gradients[2];
};

struct DenoiseWork {
    const DenoisePipelines& pipelines;
    VkDeviceAddress table = 0; ///< RtDenoise
    VkExtent2D extent{};       ///< pixels
    bool hasHistory = false;   ///< the frame continues the one before
    bool hasGradient = false;
};

/// "denoise clear", "denoise project": samples of the last frame find their pixels in this one.
void addDenoiseProject(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise, const DenoiseWork& work);
/// "denoise carry": these pixels show the samples' surface points.
void addDenoiseCarry(FrameGraph& graph, ViewResources& resources, const DenoiseResources& denoise,
                     const DenoiseWork& work);
/// "denoise gradient": by how much their light has changed.
void addDenoiseGradient(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                        const DenoiseWork& work);
/// "denoise gradient filter".
void addDenoiseGradientFilter(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                              const DenoiseWork& work);
/// "denoise temporal".
void addDenoiseTemporal(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                        const DenoiseWork& work);
/// "denoise variance".
void addDenoiseVariance(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise,
                        const DenoiseWork& work);
/// "denoise filter".
void addDenoiseFilter(FrameGraph& graph, ViewResources& resources, DenoiseResources& denoise, const DenoiseWork& work);

} // namespace q3rt
