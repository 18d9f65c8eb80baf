#pragma once
// The compute pipelines of the denoiser. They trace nothing: the same for every back end.

#include <array>

#include "gpu/compute_pipeline.hpp"
#include "shaders/shared/rt_denoise.h"

namespace q3rt {

enum class DenoiseStage { Project, Carry, Gradient, GradientFilter, Temporal, Variance, Filter };
inline constexpr size_t kDenoiseStageCount = 7;

class DenoisePipelines {
  public:
    explicit DenoisePipelines(Device& device);
    void dispatch(VkCommandBuffer commands, DenoiseStage stage, const RtDenoisePush& push, VkExtent2D extent) const;
    /// Makes the driver compile all of them now.
    void warm(VkCommandBuffer commands) const;

  private:
    std::array<ComputePipeline, kDenoiseStageCount> m_stages;
};

} // namespace q3rt
