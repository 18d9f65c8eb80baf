#pragma once
// What all pipelines share: layout, sets, push constants, specialisation.

#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

class Device;
using Spirv = std::span<const uint32_t>;

/// One shader of a pipeline. `constants[i]` is specialisation constant i (bool, int, uint or float bits).
struct ShaderStage {
    Spirv code;
    std::vector<uint32_t> constants;
};

/// Sets 0..n-1 and one push-constant block (bytes, seen by all stages).
struct PipelineInterface {
    std::vector<VkDescriptorSetLayout> sets;
    uint32_t pushConstantBytes = 0;
    VkShaderStageFlags pushStages = VK_SHADER_STAGE_ALL; // that read them
};

class Pipeline {
  public:
    Pipeline() = default;
    ~Pipeline() { release(); }
    Pipeline(Pipeline&& other) noexcept { *this = std::move(other); }
    Pipeline& operator=(Pipeline&& other) noexcept;

    explicit operator bool() const { return m_handle != VK_NULL_HANDLE; }
    VkPipeline handle() const { return m_handle; }
    VkPipelineLayout layout() const { return m_layout; }

    void bind(VkCommandBuffer commands) const;
    void bindSets(VkCommandBuffer commands, std::initializer_list<VkDescriptorSet> sets, uint32_t first = 0) const;
    template <typename T>
    void push(VkCommandBuffer commands, const T& constants) const {
        pushBytes(commands, std::as_bytes(std::span(&constants, 1)));
    }
    void pushBytes(VkCommandBuffer commands, std::span<const std::byte> bytes) const;

  protected:
    Pipeline(Device& device, VkPipelineBindPoint bindPoint, const PipelineInterface& interface, std::string name);
    /// Names the pipeline that the derived class has created.
    void finish();
    void release();
    Device* m_device = nullptr;
    VkPipelineBindPoint m_bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    VkPipelineLayout m_layout = VK_NULL_HANDLE;
    VkPipeline m_handle = VK_NULL_HANDLE;
    uint32_t m_pushConstantBytes = 0;
    VkShaderStageFlags m_pushStages = VK_SHADER_STAGE_ALL;
    std::string m_name;
};

/// Modules and specialisation data of some stages, alive while a pipeline is being created.
class StageList {
  public:
    explicit StageList(Device& device)
        : m_device(device) {}
    ~StageList();
    StageList(const StageList&) = delete;
    StageList& operator=(const StageList&) = delete;
    /// Index of the stage. Equal code given twice is one module.
    uint32_t add(VkShaderStageFlagBits stage, const ShaderStage& shader);
    const std::vector<VkPipelineShaderStageCreateInfo>& finish(); // pointers are valid until the next add()

  private:
    struct Stage {
        VkShaderStageFlagBits stage;
        VkShaderModule module;
        std::vector<uint32_t> constants;
        std::vector<VkSpecializationMapEntry> entries;
        VkSpecializationInfo specialization{};
    };
    Device& m_device;
    std::map<const uint32_t*, VkShaderModule> m_modules; // by address of the code
    std::vector<Stage> m_stages;
    std::vector<VkPipelineShaderStageCreateInfo> m_infos;
};

} // namespace q3rt
