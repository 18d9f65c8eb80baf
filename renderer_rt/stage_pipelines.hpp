#pragma once
// The pipelines of the traced frame for one back end. Everything above asks for a stage by name and never sees which
// back end runs it.

#include <array>

#include "frame/access.hpp"
#include "gpu/compute_pipeline.hpp"
#include "gpu/descriptors.hpp"
#include "gpu/ray_tracing_pipeline.hpp"
#include "renderer_rt/backend.hpp"
#include "shaders/shared/rt_scene.h"

namespace q3rt {

/// Stages that trace rays.
enum class TraceStage { Look, Primary, Direct, Shadows, Plain };
inline constexpr size_t kTraceStageCount = 5;
/// Stages between them that trace none: one text for all back ends.
enum class PointStage { Shade, Choose, Sort };
inline constexpr size_t kPointStageCount = 3;

/// What a dispatch binds.
struct StageInput {
    VkDescriptorSet textures = VK_NULL_HANDLE;
    VkDescriptorSet structures = VK_NULL_HANDLE; ///< null: the back end has none
    RtPush push{};
    VkExtent2D extent{};
    bool stagedCover = true; ///< some surface's holes take its stages to tell (RtSurface::cover)
};

class StagePipelines {
  public:
    StagePipelines(Device& device, Backend backend, VkDescriptorSetLayout textures);
    /// Few want the plain stage: it is made by this alone, at loading.
    void requirePlain(Device& device);
    bool hasPlain() const { return m_hasPlain; }
    void dispatch(VkCommandBuffer commands, TraceStage stage, const StageInput& input) const;
    void dispatch(VkCommandBuffer commands, PointStage stage, const StageInput& input) const;
    /// Runs each stage once as such an input takes it, so that the driver compiles them now.
    void warm(VkCommandBuffer commands, const StageInput& input) const;
    /// The same for what scenes whose cover is of the other kind take instead.
    void warmOtherCover(VkCommandBuffer commands, StageInput input) const;
    const DescriptorLayout& structureLayout() const { return m_structureLayout; }
    Backend backend() const { return m_backend; }
    /// How the tracing stages touch buffers and structures.
    const Access& bufferRead() const;
    const Access& bufferWrite() const;
    const Access& structureRead() const;

  private:
    void bindInput(VkCommandBuffer commands, const Pipeline& pipeline, const StageInput& input) const;
    void createTraceStage(Device& device, TraceStage stage);
    const ComputePipeline& computeStage(TraceStage stage, bool stagedCover) const;

    Backend m_backend;
    DescriptorLayout m_structureLayout;
    PipelineInterface m_interface;
    bool m_hasPlain = false;
    std::array<RayTracingPipeline, kTraceStageCount> m_tracePipelines;
    std::array<ComputePipeline, kTraceStageCount> m_computeStages;
    /// Back end `compute`: the stages that only search, for scenes without staged cover.
    std::array<ComputePipeline, kTraceStageCount> m_leanStages;
    std::array<ComputePipeline, kPointStageCount> m_pointStages;
};

} // namespace q3rt
