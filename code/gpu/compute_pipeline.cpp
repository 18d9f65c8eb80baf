#include "gpu/compute_pipeline.hpp"

#include "gpu/device.hpp"

namespace q3rt {

ComputePipeline::ComputePipeline(Device& device, const ComputePipelineInfo& info)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_COMPUTE, info.interface, info.name) {
    StageList stages(device);
    stages.add(VK_SHADER_STAGE_COMPUTE_BIT, info.shader);
    VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    create.stage = stages.finish().front();
    create.layout = m_layout;
    vkCheck(vkCreateComputePipelines(device.handle(), device.pipelineCache(), 1, &create, nullptr, &m_handle),
            "vkCreateComputePipelines");
    finish();
}

void ComputePipeline::dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z) const {
    vkCmdDispatch(commands, x, y, z);
}

void ComputePipeline::dispatchOver(VkCommandBuffer commands, VkExtent2D extent, uint32_t groupX,
                                   uint32_t groupY) const {
    vkCmdDispatch(commands, (extent.width + groupX - 1) / groupX, (extent.height + groupY - 1) / groupY, 1);
}

void ComputePipeline::warmUp(VkCommandBuffer commands) const { vkCmdDispatch(commands, 0, 0, 0); }

} // namespace q3rt
