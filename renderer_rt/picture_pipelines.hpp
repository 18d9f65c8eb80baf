#pragma once
// The pipelines that make a picture of light: composite, accumulation, exposure, anti-aliasing, output; and those that
// look after them. They trace nothing: the same for every back end.

#include <array>

#include "gpu/compute_pipeline.hpp"
#include "gpu/descriptors.hpp"
#include "shaders/shared/rt_exposure.h"
#include "shaders/shared/rt_output.h"
#include "shaders/shared/rt_report.h"

namespace q3rt {

enum class PictureStage { Composite, Accumulate, AccumulateError, ExposureCount, ExposureAdapt, Taa, CheckFinite };
inline constexpr size_t kPictureStageCount = 7;

class PicturePipelines {
  public:
    explicit PicturePipelines(Device& device);
    /// In groups of 8 x 8 invocations.
    template <typename Push>
    void dispatch(VkCommandBuffer commands, PictureStage stage, const Push& push, VkExtent2D extent) const {
        const ComputePipeline& pipeline = bind(commands, stage, push);
        pipeline.dispatchOver(commands, extent);
    }
    template <typename Push>
    void dispatchGroups(VkCommandBuffer commands, PictureStage stage, const Push& push, uint32_t groupCount) const {
        const ComputePipeline& pipeline = bind(commands, stage, push);
        pipeline.dispatch(commands, groupCount);
    }
    /// Of the set that dispatchOutput() wants: slot 0 is the target as a storage image.
    const DescriptorLayout& targetLayout() const { return m_targetLayout; }
    void dispatchOutput(VkCommandBuffer commands, VkDescriptorSet target, const RtOutput& push) const;
    /// Makes the driver compile all of them now. `target`: a set of targetLayout(), its image as for dispatchOutput().
    void warm(VkCommandBuffer commands, VkDescriptorSet target) const;

  private:
    template <typename Push>
    const ComputePipeline& bind(VkCommandBuffer commands, PictureStage stage, const Push& push) const {
        const ComputePipeline& pipeline = m_stages[static_cast<size_t>(stage)];
        pipeline.bind(commands);
        pipeline.push(commands, push);
        return pipeline;
    }

    std::array<ComputePipeline, kPictureStageCount> m_stages;
    DescriptorLayout m_targetLayout;
    ComputePipeline m_output;
};

} // namespace q3rt
