#include "gpu/ray_tracing_pipeline.hpp"

#include <algorithm>
#include <cstring>

#include "base/error.hpp"
#include "gpu/device.hpp"
#include "gpu/uploader.hpp"

namespace q3rt {
namespace {

VkDeviceSize alignUp(VkDeviceSize value, VkDeviceSize alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

VkRayTracingShaderGroupCreateInfoKHR emptyGroup(VkRayTracingShaderGroupTypeKHR type) {
    VkRayTracingShaderGroupCreateInfoKHR group{VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR};
    group.type = type;
    group.generalShader = VK_SHADER_UNUSED_KHR;
    group.closestHitShader = VK_SHADER_UNUSED_KHR;
    group.anyHitShader = VK_SHADER_UNUSED_KHR;
    group.intersectionShader = VK_SHADER_UNUSED_KHR;
    return group;
}

VkRayTracingShaderGroupCreateInfoKHR generalGroup(StageList& stages, VkShaderStageFlagBits stage,
                                                  const ShaderStage& shader) {
    VkRayTracingShaderGroupCreateInfoKHR group = emptyGroup(VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR);
    group.generalShader = stages.add(stage, shader);
    return group;
}

VkRayTracingShaderGroupCreateInfoKHR hitGroup(StageList& stages, const HitGroup& hit) {
    const bool procedural = !hit.intersection.code.empty();
    VkRayTracingShaderGroupCreateInfoKHR group =
        emptyGroup(procedural ? VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR
                              : VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR);
    if (!hit.closestHit.code.empty())
        group.closestHitShader = stages.add(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, hit.closestHit);
    if (!hit.anyHit.code.empty()) group.anyHitShader = stages.add(VK_SHADER_STAGE_ANY_HIT_BIT_KHR, hit.anyHit);
    if (procedural) group.intersectionShader = stages.add(VK_SHADER_STAGE_INTERSECTION_BIT_KHR, hit.intersection);
    return group;
}

std::vector<VkRayTracingShaderGroupCreateInfoKHR> buildGroups(StageList& stages, const RayTracingPipelineInfo& info) {
    std::vector<VkRayTracingShaderGroupCreateInfoKHR> groups;
    groups.push_back(generalGroup(stages, VK_SHADER_STAGE_RAYGEN_BIT_KHR, info.rayGeneration));
    for (const ShaderStage& miss : info.misses)
        groups.push_back(generalGroup(stages, VK_SHADER_STAGE_MISS_BIT_KHR, miss));
    for (const HitGroup& hit : info.hitGroups)
        groups.push_back(hitGroup(stages, hit));
    for (const ShaderStage& callable : info.callables)
        groups.push_back(generalGroup(stages, VK_SHADER_STAGE_CALLABLE_BIT_KHR, callable));
    return groups;
}

} // namespace

RayTracingPipeline::RayTracingPipeline(Device& device, const RayTracingPipelineInfo& info)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, info.interface, info.name) {
    const Capabilities& can = device.capabilities();
    if (!can.rayTracingPipeline)
        throw DeviceError(
            formatText("%s has no ray-tracing pipelines: set rt_backend compute", can.deviceName.c_str()));
    if (info.maxRecursion > can.rayTracing.maxRayRecursionDepth)
        throw DeviceError(formatText("pipeline \"%s\" traces %u deep; %s goes to %u", info.name.c_str(),
                                     info.maxRecursion, can.deviceName.c_str(), can.rayTracing.maxRayRecursionDepth));
    StageList stages(device);
    const std::vector<VkRayTracingShaderGroupCreateInfoKHR> groups = buildGroups(stages, info);
    // An explicit stack size is dynamic state: it stays as set until another pipeline sets its own.
    const VkDynamicState stackSize = VK_DYNAMIC_STATE_RAY_TRACING_PIPELINE_STACK_SIZE_KHR;
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = 1;
    dynamic.pDynamicStates = &stackSize;

    VkRayTracingPipelineCreateInfoKHR create{VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR};
    create.stageCount = static_cast<uint32_t>(stages.finish().size());
    create.pStages = stages.finish().data();
    create.groupCount = static_cast<uint32_t>(groups.size());
    create.pGroups = groups.data();
    create.maxPipelineRayRecursionDepth = info.maxRecursion;
    create.pDynamicState = info.stackBytes ? &dynamic : nullptr;
    create.layout = m_layout;
    vkCheck(vkCreateRayTracingPipelinesKHR(device.handle(), VK_NULL_HANDLE, device.pipelineCache(), 1, &create, nullptr,
                                           &m_handle),
            "vkCreateRayTracingPipelinesKHR");
    finish();
    m_requiredStack = measureStack(info);
    m_stack = info.stackBytes ? std::max(info.stackBytes, m_requiredStack) : 0;
    createTable(device, info);
}

uint32_t RayTracingPipeline::measureStack(const RayTracingPipelineInfo& info) const {
    const auto sizeOf = [&](uint32_t group, VkShaderGroupShaderKHR shader) {
        return static_cast<uint32_t>(
            vkGetRayTracingShaderGroupStackSizeKHR(m_device->handle(), m_handle, group, shader));
    };
    // Vulkan specification, "Ray Tracing Pipeline Stack": one ray generation; on it the deepest chain of hit or miss
    // shaders, of which only the last may be an any-hit or intersection shader; and up to two callables.
    uint32_t group = 0;
    const uint32_t generation = sizeOf(group++, VK_SHADER_GROUP_SHADER_GENERAL_KHR);
    uint32_t miss = 0, closest = 0, intersect = 0, callable = 0;
    for (size_t i = 0; i < info.misses.size(); ++i)
        miss = std::max(miss, sizeOf(group++, VK_SHADER_GROUP_SHADER_GENERAL_KHR));
    for (const HitGroup& hit : info.hitGroups) {
        const auto sizeIf = [&](const ShaderStage& shader, VkShaderGroupShaderKHR which) {
            return shader.code.empty() ? 0u : sizeOf(group, which);
        };
        closest = std::max(closest, sizeIf(hit.closestHit, VK_SHADER_GROUP_SHADER_CLOSEST_HIT_KHR));
        intersect = std::max(intersect, sizeIf(hit.anyHit, VK_SHADER_GROUP_SHADER_ANY_HIT_KHR) +
                                            sizeIf(hit.intersection, VK_SHADER_GROUP_SHADER_INTERSECTION_KHR));
        ++group;
    }
    for (size_t i = 0; i < info.callables.size(); ++i)
        callable = std::max(callable, sizeOf(group++, VK_SHADER_GROUP_SHADER_GENERAL_KHR));
    const uint32_t depth = info.maxRecursion;
    return generation + std::min(1u, depth) * std::max({closest, miss, intersect}) +
           (depth > 1 ? depth - 1 : 0) * std::max(closest, miss) + 2 * callable;
}

void RayTracingPipeline::createTable(Device& device, const RayTracingPipelineInfo& info) {
    const VkPhysicalDeviceRayTracingPipelinePropertiesKHR& limits = device.capabilities().rayTracing;
    const VkDeviceSize handleBytes = limits.shaderGroupHandleSize;
    const VkDeviceSize stride = alignUp(handleBytes, limits.shaderGroupHandleAlignment);
    const size_t counts[4] = {1, info.misses.size(), info.hitGroups.size(), info.callables.size()};
    VkStridedDeviceAddressRegionKHR* regions[4] = {&m_rayGeneration, &m_misses, &m_hits, &m_callables};
    VkDeviceSize offsets[4];
    VkDeviceSize bytes = 0;
    size_t groupCount = 0;
    for (size_t i = 0; i < 4; ++i) {
        offsets[i] = bytes;
        bytes = alignUp(bytes + counts[i] * stride, limits.shaderGroupBaseAlignment);
        groupCount += counts[i];
    }
    std::vector<std::byte> handles(groupCount * handleBytes);
    vkCheck(vkGetRayTracingShaderGroupHandlesKHR(device.handle(), m_handle, 0, static_cast<uint32_t>(groupCount),
                                                 handles.size(), handles.data()),
            "vkGetRayTracingShaderGroupHandlesKHR");
    // A buffer's address need not have the base alignment: room for one more step.
    m_table = Buffer(device, {bytes + limits.shaderGroupBaseAlignment,
                              VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                              MemoryDomain::DeviceLocal, info.name + " shader binding table"});
    const VkDeviceSize first = alignUp(m_table.address(), limits.shaderGroupBaseAlignment) - m_table.address();
    std::vector<std::byte> table(bytes);
    size_t group = 0;
    for (size_t i = 0; i < 4; ++i) {
        for (size_t entry = 0; entry < counts[i]; ++entry, ++group)
            std::memcpy(table.data() + offsets[i] + entry * stride, handles.data() + group * handleBytes, handleBytes);
        if (counts[i] > 0) *regions[i] = {m_table.address() + first + offsets[i], stride, counts[i] * stride};
    }
    Uploader uploader(device, bytes);
    uploader.upload(m_table, std::span<const std::byte>(table), first);
    uploader.flush();
}

void RayTracingPipeline::trace(VkCommandBuffer commands, uint32_t width, uint32_t height, uint32_t depth) const {
    if (m_stack) vkCmdSetRayTracingPipelineStackSizeKHR(commands, m_stack);
    vkCmdTraceRaysKHR(commands, &m_rayGeneration, &m_misses, &m_hits, &m_callables, width, height, depth);
}

} // namespace q3rt
