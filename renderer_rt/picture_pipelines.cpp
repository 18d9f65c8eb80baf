#include "renderer_rt/picture_pipelines.hpp"

#include "gpu/device.hpp"
#include "renderer_vk/gpu_context.hpp"
#include "shaders/shared/rt_output.h"
#include "shaders/shared/rt_taa.h"
#include "spirv/rt_accumulate_comp.hpp"
#include "spirv/rt_accumulate_error_comp.hpp"
#include "spirv/rt_check_finite_comp.hpp"
#include "spirv/rt_composite_comp.hpp"
#include "spirv/rt_exposure_adapt_comp.hpp"
#include "spirv/rt_exposure_count_comp.hpp"
#include "spirv/rt_output_frag.hpp"
#include "spirv/rt_output_vert.hpp"
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

PicturePipelines::PicturePipelines(Device& device) {
    for (size_t i = 0; i < kPictureStageCount; ++i)
        m_stages[i] = ComputePipeline(device, {kStages[i].name, {kStages[i].code, {}}, {{}, kStages[i].pushBytes}});
    GraphicsPipelineInfo output;
    output.name = "output";
    output.vertex = {shaders::rt_output_vert, {}};
    output.fragment = {shaders::rt_output_frag, {}};
    output.interface = {{}, sizeof(RtOutput)};
    output.colorFormats = {kTargetFormat};
    m_output = GraphicsPipeline(device, output);
}

void PicturePipelines::warm(VkCommandBuffer commands) const {
    for (const ComputePipeline& pipeline : m_stages) {
        pipeline.bind(commands);
        pipeline.warmUp(commands);
    }
}

} // namespace q3rt
