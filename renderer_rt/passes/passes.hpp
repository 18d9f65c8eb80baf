#pragma once
// The passes of a traced view, one function each. Each takes the frame's resources and replaces what it writes.

#include "renderer_rt/picture_pipelines.hpp"
#include "renderer_rt/stage_pipelines.hpp"
#include "renderer_rt/traced_scene.hpp"
#include "renderer_rt/view_buffers.hpp"
#include "renderer_vk/raster_scene.hpp"
#include "shaders/shared/rt_output.h"

namespace q3rt {

class FrameReport;

/// What rt_checkFinite needs. Lives as long as the frame's graph.
struct FiniteCheck {
    FrameReport& report;
    const PicturePipelines& pictures;
};

/// The graph's handles of one view, in their newest versions.
struct ViewResources {
    BufferId structures;                ///< a token: orders builds and traces
    BufferId looks;                     ///< RtLook[]
    BufferId pixels;                    ///< RtPixel[]
    BufferId guides, previousGuides;    ///< RtGuide[], if there is a history
    BufferId pasts;                     ///< RtPast[], likewise
    BufferId shadowRays;                ///< RtShadowRay[]
    BufferId shadowBins, shadowOrder;   ///< uint[]: places of their lights, and lists of the rays by these
    BufferId irradiance;                ///< vec4[]: direct light
    BufferId ambient;                   ///< vec4[]
    BufferId lighting;                  ///< vec4[]: irradiance, or what the denoiser made of it
    BufferId gradients;                 ///< vec4[], a stratum: change of light, if the denoiser knows it
    BufferId radiance;                  ///< vec4[]
    BufferId picture;                   ///< vec4[]: exposed
    BufferId sums;                      ///< RtSums[], if plain samples are accumulated
    BufferId reference;                 ///< vec4[]: their mean, exposed
    BufferId exposure;                  ///< RtExposure, if it is automatic
    BufferId report;                    ///< RtReport, if something is counted
    bool countsWork = false;            ///< stages that trace write into the report
    const FiniteCheck* check = nullptr; ///< null: buffers are not searched for what is no number
};

/// What the passes of one view share while they record.
struct ViewWork {
    TracedScene& scene;
    const StagePipelines& pipelines;
    const PicturePipelines& pictures;
    GpuContext& context;
    const TracedView& view; ///< lives until the graph has run
    VkExtent2D extent{};    ///< traced pixels
    VkRect2D area{};        ///< on the target
};

/// "acceleration": structures of what moves, then the top level.
void addAcceleration(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
ViewResources importView(FrameGraph& graph, ViewBuffers& buffers);
/// "look": camera rays to what they meet first.
void addLook(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "shade": pixels for which that is all to RtPixel, and to guides and pasts if there is a history.
void addShade(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "primary": the other pixels to the same, by more rays.
void addPrimary(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "plain": camera and shadow rays to a picture of white surfaces, in place of all passes up to the output.
void addPlain(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "choose": one light a pixel to unshadowed irradiance and a shadow ray.
void addChoose(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "sort": lists those rays by light.
void addSort(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "shadows": the rays take irradiance away.
void addShadows(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "direct": all lights, or several choices a pixel, to irradiance, in place of the three.
void addDirect(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
struct ExposureStep {
    bool first = false;  ///< nothing is known of the view yet
    float mostStops = 0; ///< that the exposure may change by
};
/// "exposure adapt": the exposure of this frame, from the last one's histogram.
void addExposureAdapt(FrameGraph& graph, ViewResources& resources, const ViewWork& work, const ExposureStep& step);
/// "composite": A x L + B, exposed.
void addComposite(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "exposure count": the histogram of the radiance.
void addExposureCount(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "accumulate": the plain sample into the sums, their mean into radiance and reference; "accumulate error" if there is
/// a report.
void addAccumulate(FrameGraph& graph, ViewResources& resources, const ViewWork& work);
/// "output": the picture through the output curve onto its rectangle of the target.
void addOutput(FrameGraph& graph, ViewResources& resources, FrameTargets& targets, const ViewWork& work,
               const RtOutput& output);

} // namespace q3rt
