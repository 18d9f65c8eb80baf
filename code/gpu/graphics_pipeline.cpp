#include "gpu/graphics_pipeline.hpp"

#include <algorithm>

#include "gpu/device.hpp"
#include "gpu/gpu_image.hpp"

namespace q3rt {
namespace {

std::vector<VkPipelineColorBlendAttachmentState> blendStates(const GraphicsPipelineInfo& info) {
    std::vector<VkPipelineColorBlendAttachmentState> states;
    for (size_t i = 0; i < info.colorFormats.size(); ++i) {
        const BlendInfo blend = info.blends.empty() ? BlendInfo{} : info.blends[std::min(i, info.blends.size() - 1)];
        states.push_back({blend.enable, blend.source, blend.destination, blend.op, blend.source, blend.destination,
                          blend.op, blend.writeMask});
    }
    return states;
}

VkPipelineRasterizationStateCreateInfo rasterState(const GraphicsPipelineInfo& info, const Capabilities& can) {
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.depthClampEnable = info.depthClamp && can.depthClamp;
    raster.polygonMode = can.fillModeNonSolid ? info.polygonMode : VK_POLYGON_MODE_FILL;
    raster.cullMode = info.cullMode;
    raster.frontFace = info.frontFace;
    raster.depthBiasEnable = info.depthBias;
    raster.depthBiasConstantFactor = info.depthBiasConstant;
    raster.depthBiasSlopeFactor = info.depthBiasSlope;
    raster.lineWidth = 1.0f;
    return raster;
}

VkPipelineDepthStencilStateCreateInfo depthState(const GraphicsPipelineInfo& info) {
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = info.depthTest;
    depth.depthWriteEnable = info.depthWrite;
    depth.depthCompareOp = info.depthCompare;
    depth.stencilTestEnable = info.stencil.has_value();
    if (info.stencil) depth.front = depth.back = *info.stencil;
    return depth;
}

bool hasStencil(VkFormat format) {
    return format != VK_FORMAT_UNDEFINED && (aspectOf(format) & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
}

VkRenderingAttachmentInfoKHR attachmentInfo(const Attachment& attachment, VkImageLayout layout) {
    VkRenderingAttachmentInfoKHR info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO_KHR};
    info.imageView = attachment.view;
    info.imageLayout = layout;
    info.loadOp = attachment.load;
    info.storeOp = attachment.store;
    info.clearValue = attachment.clear;
    if (attachment.resolve) {
        info.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
        info.resolveImageView = attachment.resolve;
        info.resolveImageLayout = layout;
    }
    return info;
}

} // namespace

GraphicsPipeline::GraphicsPipeline(Device& device, const GraphicsPipelineInfo& info)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_GRAPHICS, info.interface, info.name) {
    StageList stages(device);
    stages.add(VK_SHADER_STAGE_VERTEX_BIT, info.vertex);
    if (!info.fragment.code.empty()) stages.add(VK_SHADER_STAGE_FRAGMENT_BIT, info.fragment);

    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = static_cast<uint32_t>(info.vertexBindings.size());
    input.pVertexBindingDescriptions = info.vertexBindings.data();
    input.vertexAttributeDescriptionCount = static_cast<uint32_t>(info.vertexAttributes.size());
    input.pVertexAttributeDescriptions = info.vertexAttributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = info.topology;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    const VkPipelineRasterizationStateCreateInfo raster = rasterState(info, device.capabilities());
    VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = info.samples;
    const VkPipelineDepthStencilStateCreateInfo depth = depthState(info);
    const std::vector<VkPipelineColorBlendAttachmentState> attachments = blendStates(info);
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = static_cast<uint32_t>(attachments.size());
    blend.pAttachments = attachments.data();
    std::vector<VkDynamicState> dynamicStates = info.dynamicStates;
    dynamicStates.insert(dynamicStates.end(), {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR});
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = static_cast<uint32_t>(dynamicStates.size());
    dynamic.pDynamicStates = dynamicStates.data();
    VkPipelineRenderingCreateInfoKHR rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO_KHR};
    rendering.colorAttachmentCount = static_cast<uint32_t>(info.colorFormats.size());
    rendering.pColorAttachmentFormats = info.colorFormats.data();
    rendering.depthAttachmentFormat = info.depthFormat;
    if (hasStencil(info.depthFormat)) rendering.stencilAttachmentFormat = info.depthFormat;

    VkGraphicsPipelineCreateInfo create{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    create.pNext = &rendering;
    create.stageCount = static_cast<uint32_t>(stages.finish().size());
    create.pStages = stages.finish().data();
    create.pVertexInputState = &input;
    create.pInputAssemblyState = &assembly;
    create.pViewportState = &viewport;
    create.pRasterizationState = &raster;
    create.pMultisampleState = &multisample;
    create.pDepthStencilState = &depth;
    create.pColorBlendState = &blend;
    create.pDynamicState = &dynamic;
    create.layout = m_layout;
    vkCheck(vkCreateGraphicsPipelines(device.handle(), device.pipelineCache(), 1, &create, nullptr, &m_handle),
            "vkCreateGraphicsPipelines");
    finish();
}

void GraphicsPipeline::warmUp(VkCommandBuffer commands) const {
    const VkRect2D nowhere{};
    vkCmdSetScissor(commands, 0, 1, &nowhere);
    vkCmdDraw(commands, 3, 1, 0, 0);
}

void beginRendering(VkCommandBuffer commands, VkExtent2D extent, const Attachment& color, const Attachment& depth) {
    const VkRenderingAttachmentInfoKHR colorInfo = attachmentInfo(color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    const VkRenderingAttachmentInfoKHR depthInfo =
        attachmentInfo(depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    VkRenderingInfoKHR rendering{VK_STRUCTURE_TYPE_RENDERING_INFO_KHR};
    rendering.renderArea = {{0, 0}, extent};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &colorInfo;
    rendering.pDepthAttachment = depth.view ? &depthInfo : nullptr;
    rendering.pStencilAttachment = depth.view && depth.stencil ? &depthInfo : nullptr;
    vkCmdBeginRenderingKHR(commands, &rendering);
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &rendering.renderArea);
}

} // namespace q3rt
