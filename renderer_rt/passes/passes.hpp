#pragma once
// The passes of a traced view, one function each. Each takes the frame's resources and replaces what it writes.

#include "renderer_rt/stage_pipelines.hpp"
#include "renderer_rt/traced_scene.hpp"
#include "renderer_rt/view_buffers.hpp"
#include "renderer_vk/raster_scene.hpp"
#include "shaders/shared/rt_output.h"

namespace q3rt {

/// The graph's handles of one view, in their newest versions.
struct ViewResources {
    BufferId structures;             ///< a token: orders builds and traces
    BufferId pixels;                 ///< RtPixel[]
    BufferId guides, previousGuides; ///< RtGuide[], if there is a history
    BufferId pasts;                  ///< RtPast[], likewise
    BufferId irradiance;             ///< vec4[]: direct light
    BufferId ambient;                ///< vec4[]
    BufferId lighting;               ///< vec4[]: irradiance, or what the denoiser made of it
    BufferId gradients;              ///< vec2[], a stratum: change of light, if the denoiser knows it
    BufferId radiance;               ///< vec4[]: running mean, kept between frames
    BufferId means;                  ///< RtMean[], kept between frames
    BufferId picture;                ///< vec4[]: exposed
};

/// What the passes of one view share while they record.
struct ViewWork {
    TracedScene& scene;
    const StagePipelines& pipelines;
    GpuContext& context;
    const TracedView& view; ///< lives until the graph has run
    VkExtent2D extent{};
};

/// "acceleration": structures of what moves, then the top level.
void addAcceleration(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
ViewResources importView(FrameGraph& graph, ViewBuffers& buffers);
/// "primary": camera rays to RtPixel, and to guides and pasts if there is a history.
void addPrimary(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "direct": shadow rays to irradiance.
void addDirect(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "composite": A x L + B into the running mean.
void addComposite(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "output": the mean through the output curve onto the view's rectangle of the target.
void addOutput(FrameGraph& graph, ViewResources& resources, FrameTargets& targets, const ViewWork& work,
               const RtOutput& output);

} // namespace q3rt
