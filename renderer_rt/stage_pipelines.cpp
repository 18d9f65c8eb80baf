#include "renderer_rt/stage_pipelines.hpp"

#include "gpu/device.hpp"
#include "renderer_rt/view_buffers.hpp"
#include "spirv/rt_choose_comp.hpp"
#include "spirv/rt_direct_compute.hpp"
#include "spirv/rt_direct_query.hpp"
#include "spirv/rt_direct_rgen.hpp"
#include "spirv/rt_look_compute.hpp"
#include "spirv/rt_look_query.hpp"
#include "spirv/rt_look_rgen.hpp"
#include "spirv/rt_plain_compute.hpp"
#include "spirv/rt_plain_query.hpp"
#include "spirv/rt_plain_rgen.hpp"
#include "spirv/rt_primary_compute.hpp"
#include "spirv/rt_primary_query.hpp"
#include "spirv/rt_primary_rgen.hpp"
#include "spirv/rt_shade_comp.hpp"
#include "spirv/rt_shadows_compute.hpp"
#include "spirv/rt_shadows_query.hpp"
#include "spirv/rt_shadows_rgen.hpp"
#include "spirv/rt_sort_comp.hpp"
#include "spirv/trace_accept_rahit.hpp"
#include "spirv/trace_layers_rahit.hpp"
#include "spirv/trace_layers_rmiss.hpp"
#include "spirv/trace_record_rchit.hpp"
#include "spirv/trace_record_rmiss.hpp"

namespace q3rt {

namespace {

struct StageCode {
    const char* name;
    Spirv rayGeneration, query, compute;
};

StageCode codeOf(TraceStage stage) {
    if (stage == TraceStage::Look)
        return {"look", shaders::rt_look_rgen, shaders::rt_look_query, shaders::rt_look_compute};
    if (stage == TraceStage::Primary)
        return {"primary", shaders::rt_primary_rgen, shaders::rt_primary_query, shaders::rt_primary_compute};
    if (stage == TraceStage::Plain)
        return {"plain", shaders::rt_plain_rgen, shaders::rt_plain_query, shaders::rt_plain_compute};
    if (stage == TraceStage::Shadows)
        return {"shadows", shaders::rt_shadows_rgen, shaders::rt_shadows_query, shaders::rt_shadows_compute};
    return {"direct", shaders::rt_direct_rgen, shaders::rt_direct_query, shaders::rt_direct_compute};
}

/// Does it search and little else? Then what a material's stages need is most of its registers.
bool onlySearches(TraceStage stage) {
    return stage == TraceStage::Look || stage == TraceStage::Direct || stage == TraceStage::Shadows;
}

/// What one stage wrote the next one reads.
void orderStages(VkCommandBuffer commands) {
    const VkMemoryBarrier2 order{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                 .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                 .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                 .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
    const VkDependencyInfo dependency{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &order};
    vkCmdPipelineBarrier2KHR(commands, &dependency);
}

template <typename Stage>
size_t indexOf(Stage stage) {
    return static_cast<size_t>(stage);
}

} // namespace

StagePipelines::StagePipelines(Device& device, Backend backend, VkDescriptorSetLayout textures)
    : m_backend(backend) {
    m_interface.sets = {textures};
    m_interface.pushConstantBytes = sizeof(RtPush);
    if (usesStructures(backend)) {
        m_structureLayout =
            DescriptorLayout(device, {{0, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR}}, "traced scene");
        m_interface.sets.push_back(m_structureLayout.handle());
    }
    createTraceStage(device, TraceStage::Look);
    createTraceStage(device, TraceStage::Primary);
    createTraceStage(device, TraceStage::Direct);
    createTraceStage(device, TraceStage::Shadows);
    const PipelineInterface interface { .sets = {textures}, .pushConstantBytes = sizeof(RtPush) };
    m_pointStages[indexOf(PointStage::Shade)] =
        ComputePipeline(device, {"shade", {shaders::rt_shade_comp, {}}, interface});
    m_pointStages[indexOf(PointStage::Choose)] =
        ComputePipeline(device, {"choose", {shaders::rt_choose_comp, {}}, interface});
    m_pointStages[indexOf(PointStage::Sort)] =
        ComputePipeline(device, {"sort", {shaders::rt_sort_comp, {}}, interface});
}

void StagePipelines::requirePlain(Device& device) {
    if (!m_hasPlain) createTraceStage(device, TraceStage::Plain);
    m_hasPlain = true;
}

void StagePipelines::createTraceStage(Device& device, TraceStage stage) {
    const StageCode code = codeOf(stage);
    if (m_backend != Backend::Pipeline) {
        ShaderStage shader{code.query, {}};
        if (m_backend == Backend::Compute) shader = {code.compute, traversalConstants(device.capabilities(), true)};
        m_computeStages[indexOf(stage)] = ComputePipeline(device, {code.name, shader, m_interface});
        if (m_backend != Backend::Compute || !onlySearches(stage)) return;
        shader.constants = traversalConstants(device.capabilities(), false);
        m_leanStages[indexOf(stage)] = ComputePipeline(device, {code.name, shader, m_interface});
        return;
    }
    RayTracingPipelineInfo info;
    info.name = code.name;
    info.rayGeneration = {code.rayGeneration, {}};
    info.misses = {{shaders::trace_record_rmiss, {}}, {shaders::trace_layers_rmiss, {}}};
    info.hitGroups.resize(kHitGroupCount);
    info.hitGroups[kHitGroupRecord] = {
        .closestHit = {shaders::trace_record_rchit, {}}, .anyHit = {}, .intersection = {}};
    // The plain stage takes all solids as opaque.
    if (stage != TraceStage::Plain) info.hitGroups[kHitGroupRecord].anyHit = {shaders::trace_accept_rahit, {}};
    info.hitGroups[kHitGroupLayers] = {
        .closestHit = {}, .anyHit = {shaders::trace_layers_rahit, {}}, .intersection = {}};
    info.interface = m_interface;
    m_tracePipelines[indexOf(stage)] = RayTracingPipeline(device, info);
}

void StagePipelines::bindInput(VkCommandBuffer commands, const Pipeline& pipeline, const StageInput& input) const {
    pipeline.bind(commands);
    if (usesStructures(m_backend))
        pipeline.bindSets(commands, {input.textures, input.structures});
    else
        pipeline.bindSets(commands, {input.textures});
    pipeline.push(commands, input.push);
}

const ComputePipeline& StagePipelines::computeStage(TraceStage stage, bool stagedCover) const {
    const bool lean = m_backend == Backend::Compute && onlySearches(stage) && !stagedCover;
    return (lean ? m_leanStages : m_computeStages)[indexOf(stage)];
}

void StagePipelines::dispatch(VkCommandBuffer commands, TraceStage stage, const StageInput& input) const {
    if (m_backend == Backend::Pipeline) {
        const RayTracingPipeline& pipeline = m_tracePipelines[indexOf(stage)];
        bindInput(commands, pipeline, input);
        pipeline.trace(commands, input.extent.width, input.extent.height);
        return;
    }
    const ComputePipeline& pipeline = computeStage(stage, input.stagedCover);
    bindInput(commands, pipeline, input);
    pipeline.dispatchOver(commands, input.extent);
}

void StagePipelines::dispatch(VkCommandBuffer commands, PointStage stage, const StageInput& input) const {
    const ComputePipeline& pipeline = m_pointStages[indexOf(stage)];
    pipeline.bind(commands);
    pipeline.bindSets(commands, {input.textures});
    pipeline.push(commands, input.push);
    const uint32_t side = stage == PointStage::Sort ? kShadowTile : 8;
    pipeline.dispatchOver(commands, input.extent, side, side);
}

void StagePipelines::warm(VkCommandBuffer commands, const StageInput& input) const {
    const auto run = [&](auto stage, VkExtent2D extent) {
        dispatch(commands, stage, {input.textures, input.structures, input.push, extent, input.stagedCover});
        orderStages(commands);
    };
    run(TraceStage::Look, input.extent);
    run(PointStage::Shade, input.extent);
    run(TraceStage::Primary, input.extent);
    run(PointStage::Choose, input.extent);
    run(PointStage::Sort, input.extent);
    run(TraceStage::Shadows, wholeTiles(input.extent));
    run(TraceStage::Direct, input.extent);
    if (m_hasPlain) run(TraceStage::Plain, input.extent);
}

void StagePipelines::warmOtherCover(VkCommandBuffer commands, StageInput input) const {
    input.stagedCover = !input.stagedCover;
    for (const TraceStage stage : {TraceStage::Look, TraceStage::Primary, TraceStage::Direct, TraceStage::Shadows}) {
        if (&computeStage(stage, true) == &computeStage(stage, false)) continue;
        dispatch(commands, stage, input);
        orderStages(commands);
    }
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
