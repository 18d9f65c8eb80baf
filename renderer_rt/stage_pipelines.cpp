#include "renderer_rt/stage_pipelines.hpp"

#include <string>

#include "base/error.hpp"
#include "gpu/capabilities.hpp"
#include "gpu/device.hpp"
#include "renderer_vk/gpu_context.hpp"
#include "shaders/shared/rt_output.h"
#include "spirv/rt_composite_comp.hpp"
#include "spirv/rt_direct_query.hpp"
#include "spirv/rt_direct_rgen.hpp"
#include "spirv/rt_output_frag.hpp"
#include "spirv/rt_output_vert.hpp"
#include "spirv/rt_primary_query.hpp"
#include "spirv/rt_primary_rgen.hpp"
#include "spirv/trace_accept_rahit.hpp"
#include "spirv/trace_layers_rahit.hpp"
#include "spirv/trace_layers_rmiss.hpp"
#include "spirv/trace_record_rchit.hpp"
#include "spirv/trace_record_rmiss.hpp"
#include "spirv/trace_visible_rmiss.hpp"

namespace q3rt {

namespace {

struct StageCode {
    const char* name;
    Spirv rayGeneration, query;
};

StageCode codeOf(TraceStage stage) {
    if (stage == TraceStage::Primary) return {"primary", shaders::rt_primary_rgen, shaders::rt_primary_query};
    return {"direct", shaders::rt_direct_rgen, shaders::rt_direct_query};
}

size_t indexOf(TraceStage stage) { return static_cast<size_t>(stage); }

} // namespace

const char* nameOf(Backend backend) { return backend == Backend::Pipeline ? "pipeline" : "query"; }

Backend chooseBackend(std::string_view wanted, const Capabilities& can) {
    const bool pipeline = can.accelerationStructure && can.rayTracingPipeline;
    const bool query = can.accelerationStructure && can.rayQuery;
    const std::string device = can.deviceName;
    if (wanted == "pipeline" || wanted == "auto") {
        if (pipeline) return Backend::Pipeline;
        if (wanted == "auto" && query) return Backend::Query;
        throw DeviceError(device +
                          " has no ray-tracing pipelines: use cl_renderer vk, another r_device, or a driver with "
                          "VK_KHR_ray_tracing_pipeline (q3rt doctor lists them)");
    }
    if (wanted == "query") {
        if (query) return Backend::Query;
        throw DeviceError(device + " has no ray queries: set rt_backend auto");
    }
    throw UsageError("rt_backend \"" + std::string(wanted) + "\" is unknown: use auto, pipeline or query");
}

StagePipelines::StagePipelines(Device& device, Backend backend, VkDescriptorSetLayout textures)
    : m_backend(backend)
    , m_structureLayout(device, {{0, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR}}, "traced scene") {
    const PipelineInterface interface { {textures, m_structureLayout.handle()}, sizeof(RtPush) };
    createTraceStage(device, TraceStage::Primary, interface);
    createTraceStage(device, TraceStage::Direct, interface);
    m_composite = ComputePipeline(device, {"composite", {shaders::rt_composite_comp, {}}, interface});
    GraphicsPipelineInfo output;
    output.name = "output";
    output.vertex = {shaders::rt_output_vert, {}};
    output.fragment = {shaders::rt_output_frag, {}};
    output.interface = {{}, sizeof(RtOutput)};
    output.colorFormats = {kTargetFormat};
    m_output = GraphicsPipeline(device, output);
}

void StagePipelines::createTraceStage(Device& device, TraceStage stage, const PipelineInterface& interface) {
    const StageCode code = codeOf(stage);
    if (m_backend == Backend::Query) {
        m_computeStages[indexOf(stage)] = ComputePipeline(device, {code.name, {code.query, {}}, interface});
        return;
    }
    RayTracingPipelineInfo info;
    info.name = code.name;
    info.rayGeneration = {code.rayGeneration, {}};
    info.misses = {
        {shaders::trace_record_rmiss, {}}, {shaders::trace_visible_rmiss, {}}, {shaders::trace_layers_rmiss, {}}};
    info.hitGroups.resize(kHitGroupCount);
    info.hitGroups[kHitGroupRecord] = {.closestHit = {shaders::trace_record_rchit, {}},
                                       .anyHit = {shaders::trace_accept_rahit, {}},
                                       .intersection = {}};
    info.hitGroups[kHitGroupLayers] = {
        .closestHit = {}, .anyHit = {shaders::trace_layers_rahit, {}}, .intersection = {}};
    info.interface = interface;
    m_tracePipelines[indexOf(stage)] = RayTracingPipeline(device, info);
}

void StagePipelines::dispatch(VkCommandBuffer commands, TraceStage stage, const StageInput& input) const {
    if (m_backend == Backend::Pipeline) {
        const RayTracingPipeline& pipeline = m_tracePipelines[indexOf(stage)];
        pipeline.bind(commands);
        pipeline.bindSets(commands, {input.textures, input.structures});
        pipeline.push(commands, input.push);
        pipeline.trace(commands, input.extent.width, input.extent.height);
        return;
    }
    const ComputePipeline& pipeline = m_computeStages[indexOf(stage)];
    pipeline.bind(commands);
    pipeline.bindSets(commands, {input.textures, input.structures});
    pipeline.push(commands, input.push);
    pipeline.dispatchOver(commands, input.extent);
}

void StagePipelines::dispatchComposite(VkCommandBuffer commands, const StageInput& input) const {
    m_composite.bind(commands);
    m_composite.bindSets(commands, {input.textures, input.structures});
    m_composite.push(commands, input.push);
    m_composite.dispatchOver(commands, input.extent);
}

void StagePipelines::warm(VkCommandBuffer commands, const StageInput& input) const {
    const VkMemoryBarrier2 order{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                 .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                 .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                 .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &order};
    dispatch(commands, TraceStage::Primary, input);
    vkCmdPipelineBarrier2KHR(commands, &dependency);
    dispatch(commands, TraceStage::Direct, input);
    vkCmdPipelineBarrier2KHR(commands, &dependency);
    dispatchComposite(commands, input);
}

const Access& StagePipelines::bufferRead() const {
    return m_backend == Backend::Pipeline ? access::kRayRead : access::kComputeRead;
}

const Access& StagePipelines::bufferWrite() const {
    return m_backend == Backend::Pipeline ? access::kRayWrite : access::kComputeWrite;
}

const Access& StagePipelines::structureRead() const {
    return m_backend == Backend::Pipeline ? access::kRayTrace : access::kQueryTrace;
}

} // namespace q3rt
