#include "renderer_rt/denoise_pipelines.hpp"

#include "gpu/device.hpp"
#include "spirv/rt_denoise_carry_comp.hpp"
#include "spirv/rt_denoise_filter_comp.hpp"
#include "spirv/rt_denoise_gradient_comp.hpp"
#include "spirv/rt_denoise_gradient_filter_comp.hpp"
#include "spirv/rt_denoise_project_comp.hpp"
#include "spirv/rt_denoise_temporal_comp.hpp"
#include "spirv/rt_denoise_variance_comp.hpp"

namespace q3rt {

namespace {

struct StageCode {
    const char* name;
    Spirv code;
};

/// In the order of DenoiseStage.
const StageCode kStages[kDenoiseStageCount] = {{"denoise project", shaders::rt_denoise_project_comp},
                                               {"denoise carry", shaders::rt_denoise_carry_comp},
                                               {"denoise gradient", shaders::rt_denoise_gradient_comp},
                                               {"denoise gradient filter", shaders::rt_denoise_gradient_filter_comp},
                                               {"denoise temporal", shaders::rt_denoise_temporal_comp},
                                               {"denoise variance", shaders::rt_denoise_variance_comp},
                                               {"denoise filter", shaders::rt_denoise_filter_comp}};

} // namespace

DenoisePipelines::DenoisePipelines(Device& device) {
    for (size_t i = 0; i < kDenoiseStageCount; ++i)
        m_stages[i] = ComputePipeline(device, {kStages[i].name, {kStages[i].code, {}}, {{}, sizeof(RtDenoisePush)}});
}

void DenoisePipelines::dispatch(VkCommandBuffer commands, DenoiseStage stage, const RtDenoisePush& push,
                                VkExtent2D extent) const {
    const ComputePipeline& pipeline = m_stages[static_cast<size_t>(stage)];
    pipeline.bind(commands);
    pipeline.push(commands, push);
    pipeline.dispatchOver(commands, extent);
}

void DenoisePipelines::warm(VkCommandBuffer commands) const {
    for (const ComputePipeline& pipeline : m_stages) {
        pipeline.bind(commands);
        pipeline.push(commands, RtDenoisePush{});
        pipeline.warmUp(commands);
    }
}

} // namespace q3rt
