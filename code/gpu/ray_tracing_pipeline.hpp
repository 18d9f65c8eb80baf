#pragma once
// A ray-tracing pipeline (VK_KHR_ray_tracing_pipeline) with its shader binding table.
// Group order in the table: ray generation, misses in list order, hit groups in list order, callables in list order.

#include "gpu/buffer.hpp"
#include "gpu/pipeline.hpp"

namespace q3rt {

/// Any of the three may have no code.
struct HitGroup {
    ShaderStage closestHit;
    ShaderStage anyHit;
    ShaderStage intersection; // makes it a procedural group
};

struct RayTracingPipelineInfo {
    std::string name = "trace";
    ShaderStage rayGeneration;
    std::vector<ShaderStage> misses;
    std::vector<HitGroup> hitGroups;
    std::vector<ShaderStage> callables;
    PipelineInterface interface;
    uint32_t maxRecursion = 1;
    /// Stack bytes set explicitly and alike for all pipelines of a frame (an H200 was slow with unequal ones);
    /// 0 leaves the driver's own size. Raised to what the shaders need if smaller.
    uint32_t stackBytes = 0;
};

class RayTracingPipeline : public Pipeline {
  public:
    RayTracingPipeline() = default;
    RayTracingPipeline(Device& device, const RayTracingPipelineInfo& info);
    /// One ray-generation invocation a pixel.
    void trace(VkCommandBuffer commands, uint32_t width, uint32_t height = 1, uint32_t depth = 1) const;
    /// An empty dispatch, so that lavapipe compiles at load.
    void warmUp(VkCommandBuffer commands) const { trace(commands, 0, 0, 0); }
    /// Bytes of stack that the shaders need at maxRecursion, by the specification's formula.
    uint32_t requiredStackBytes() const { return m_requiredStack; }

  private:
    void createTable(Device& device, const RayTracingPipelineInfo& info);
    uint32_t measureStack(const RayTracingPipelineInfo& info) const;

    Buffer m_table;
    VkStridedDeviceAddressRegionKHR m_rayGeneration{};
    VkStridedDeviceAddressRegionKHR m_misses{};
    VkStridedDeviceAddressRegionKHR m_hits{};
    VkStridedDeviceAddressRegionKHR m_callables{};
    uint32_t m_requiredStack = 0;
    uint32_t m_stack = 0;
};

} // namespace q3rt
