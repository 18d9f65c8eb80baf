#include "renderer_rt/picture_pipelines.hpp"

#include "gpu/device.hpp"
#include "shaders/shared/rt_taa.h"
#include "spirv/rt_accumulate_comp.hpp"
#include "spirv/rt_accumulate_error_comp.hpp"
#include "spirv/rt_check_finite_comp.hpp"
#include "spirv/rt_composite_comp.hpp"
#include "spirv/rt_exposure_adapt_comp.hpp"
#include "spirv/rt_exposure_count_comp.hpp"
#include "spirv/rt_output_comp.hpp"
#include "spirv/rt_taa_comp.hpp"

namespace q3rt {

namespace {

struct StageCode {
    const char* name;
    Spirv code;
    uint32_t pushBytes;
};

/// In the order of PictureStage.
const StageCode kStages[kPictureStageCount] = {
    {"composite", shaders::rt_composite_comp, sizeof(RtPush)},
    {"accumulate", shaders::rt_accumulate_comp, sizeof(RtPush)},
    {"accumulate error", shaders::rt_accumulate_error_comp, sizeof(RtPush)},
    {"exposure count", shaders::rt_exposure_count_comp, sizeof(RtExposurePush)},
    {"exposure adapt", shaders::rt_exposure_adapt_comp, sizeof(RtExposurePush)},
    {"taa", shaders::rt_taa_comp, sizeof(RtTaaPush)},
    {"check finite", shaders::rt_check_finite_comp, sizeof(RtCheckPush)}};

} // namespace

PicturePipelines::PicturePipelines(Device& device)
    : m_targetLayout(device, {{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_COMPUTE_BIT}}, "output target")
    , m_output(device, {"output", {shaders::rt_output_comp, {}}, {{m_targetLayout.handle()}, sizeof(RtOutput)}}) {
    for (size_t i = 0; i < kPictureStageCount; ++i)
        m_stages[i] = ComputePipeline(device, {kStages[i].name, {kStages[i].code, {}}, {{}, kStages[i].pushBytes}});
}

void PicturePipelines::dispatchOutput(VkCommandBuffer commands, VkDescriptorSet target, const RtOutput& push) const {
    m_output.bind(commands);
    m_output.bindSets(commands, {target});
    m_output.push(commands, push);
    m_output.dispatchOver(commands, {push.size.x - push.firstColumn, push.size.y});
}

void PicturePipelines::warm(VkCommandBuffer commands, VkDescriptorSet target) const {
    for (const ComputePipeline& pipeline : m_stages) {
        pipeline.bind(commands);
        pipeline.warmUp(commands);
    }
    m_output.bind(commands);
    m_output.bindSets(commands, {target});
    m_output.warmUp(commands);
}

} // namespace q3rt
