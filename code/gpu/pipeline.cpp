#include "gpu/pipeline.hpp"

#include <utility>

#include "base/error.hpp"
#include "gpu/device.hpp"

namespace q3rt {

Pipeline::Pipeline(Device& device, VkPipelineBindPoint bindPoint, const PipelineInterface& interface, std::string name)
    : m_device(&device)
    , m_bindPoint(bindPoint)
    , m_pushConstantBytes(interface.pushConstantBytes)
    , m_pushStages(interface.pushStages)
    , m_name(std::move(name)) {
    if (m_pushConstantBytes > device.capabilities().limits.maxPushConstantsSize)
        throw DeviceError(formatText("pipeline \"%s\" needs %u bytes of push constants; %s has %u", m_name.c_str(),
                                     m_pushConstantBytes, device.capabilities().deviceName.c_str(),
                                     device.capabilities().limits.maxPushConstantsSize));
    const VkPushConstantRange range{m_pushStages, 0, m_pushConstantBytes};
    VkPipelineLayoutCreateInfo create{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    create.setLayoutCount = static_cast<uint32_t>(interface.sets.size());
    create.pSetLayouts = interface.sets.data();
    create.pushConstantRangeCount = m_pushConstantBytes ? 1 : 0;
    create.pPushConstantRanges = &range;
    vkCheck(vkCreatePipelineLayout(device.handle(), &create, nullptr, &m_layout), "vkCreatePipelineLayout");
}

Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
    if (this == &other) return *this;
    release();
    m_device = std::exchange(other.m_device, nullptr);
    m_bindPoint = other.m_bindPoint;
    m_layout = std::exchange(other.m_layout, VK_NULL_HANDLE);
    m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
    m_pushConstantBytes = std::exchange(other.m_pushConstantBytes, 0);
    m_pushStages = other.m_pushStages;
    m_name = std::move(other.m_name);
    return *this;
}

void Pipeline::release() {
    if (!m_layout) return;
    m_device->retire([device = m_device->handle(), pipeline = m_handle, layout = m_layout] {
        vkDestroyPipeline(device, pipeline, nullptr);
        vkDestroyPipelineLayout(device, layout, nullptr);
    });
    m_handle = VK_NULL_HANDLE;
    m_layout = VK_NULL_HANDLE;
}

void Pipeline::bind(VkCommandBuffer commands) const { vkCmdBindPipeline(commands, m_bindPoint, m_handle); }

void Pipeline::bindSets(VkCommandBuffer commands, std::initializer_list<VkDescriptorSet> sets, uint32_t first) const {
    vkCmdBindDescriptorSets(commands, m_bindPoint, m_layout, first, static_cast<uint32_t>(sets.size()), sets.begin(), 0,
                            nullptr);
}

void Pipeline::pushBytes(VkCommandBuffer commands, std::span<const std::byte> bytes) const {
    if (bytes.size() > m_pushConstantBytes)
        throw UsageError(formatText("pipeline \"%s\" takes %u bytes of push constants, %zu were given", m_name.c_str(),
                                    m_pushConstantBytes, bytes.size()));
    vkCmdPushConstants(commands, m_layout, m_pushStages, 0, static_cast<uint32_t>(bytes.size()), bytes.data());
}

void Pipeline::finish() { m_device->setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(m_handle), m_name); }

StageList::~StageList() {
    for (const auto& [code, module] : m_modules)
        vkDestroyShaderModule(m_device.handle(), module, nullptr);
}

uint32_t StageList::add(VkShaderStageFlagBits stage, const ShaderStage& shader) {
    auto& module = m_modules[shader.code.data()];
    if (!module) {
        VkShaderModuleCreateInfo create{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        create.codeSize = shader.code.size_bytes();
        create.pCode = shader.code.data();
        vkCheck(vkCreateShaderModule(m_device.handle(), &create, nullptr, &module), "vkCreateShaderModule");
    }
    Stage added{stage, module, shader.constants, {}, {}};
    for (uint32_t i = 0; i < added.constants.size(); ++i)
        added.entries.push_back({i, i * uint32_t{sizeof(uint32_t)}, sizeof(uint32_t)});
    m_stages.push_back(std::move(added));
    return static_cast<uint32_t>(m_stages.size() - 1);
}

const std::vector<VkPipelineShaderStageCreateInfo>& StageList::finish() {
    m_infos.clear();
    for (Stage& stage : m_stages) {
        stage.specialization = {static_cast<uint32_t>(stage.entries.size()), stage.entries.data(),
                                stage.constants.size() * sizeof(uint32_t), stage.constants.data()};
        VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        info.stage = stage.stage;
        info.module = stage.module;
        info.pName = "main";
        info.pSpecializationInfo = stage.constants.empty() ? nullptr : &stage.specialization;
        m_infos.push_back(info);
    }
    return m_infos;
}

} // namespace q3rt
