#pragma once
// A compute shader ready to dispatch.

#include "gpu/pipeline.hpp"

namespace q3rt {

struct ComputePipelineInfo {
    std::string name = "compute";
    ShaderStage shader;
    PipelineInterface interface;
};

class ComputePipeline : public Pipeline {
  public:
    ComputePipeline() = default;
    ComputePipeline(Device& device, const ComputePipelineInfo& info);
    /// Work groups, not invocations. Bind, sets and push constants come before.
    void dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y = 1, uint32_t z = 1) const;
    /// Enough groups of `groupX` x `groupY` invocations to cover `extent`.
    void dispatchOver(VkCommandBuffer commands, VkExtent2D extent, uint32_t groupX = 8, uint32_t groupY = 8) const;
    /// lavapipe compiles at the first dispatch: an empty one at load (sets bound by the caller, who may pass dummies)
    /// moves that out of play. Records a dispatch of 0 groups.
    void warmUp(VkCommandBuffer commands) const;
};

} // namespace q3rt
