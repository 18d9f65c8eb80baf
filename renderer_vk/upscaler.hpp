#pragma once
// The world drawn at a scale (r_renderScale) onto the picture: larger by interpolation, smaller by its mean.

#include "frame/frame_graph.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/graphics_pipeline.hpp"

namespace q3rt {

struct TargetImages;
struct FrameTargets;

class Upscaler {
  public:
    /// Makes its pipeline, which software drivers compile now.
    Upscaler(Device& device, TargetImages& from, TargetImages& to);
    /// The part of a picture of size `to` that stands for `area` of one of size `from`.
    static VkRect2D scaledArea(const VkRect2D& area, VkExtent2D from, VkExtent2D to);
    /// A pass that draws `drawn` of `world` over `shown` of the targets.
    void addPass(FrameGraph& graph, ImageId world, const VkRect2D& drawn, FrameTargets& targets, const VkRect2D& shown);

  private:
    void warm(TargetImages& from, TargetImages& to);
    void draw(VkCommandBuffer commands, VkDescriptorSet set, const VkRect2D& drawn, VkExtent2D size,
              const VkRect2D& shown) const;

    Device& m_device;
    DescriptorLayout m_layout;
    GraphicsPipeline m_pipeline;
    VkSampler m_sampler;
};

} // namespace q3rt
