#include "gpu/bindless_textures.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "gpu/device.hpp"

namespace q3rt {

struct BindlessTextures::FreeList {
    std::vector<uint32_t> indices;
};

BindlessTextures::BindlessTextures(Device& device, VkImageView fallback, VkSampler fallbackSampler, uint32_t capacity)
    : m_device(device)
    , m_fallback{fallback, fallbackSampler}
    , m_free(std::make_shared<FreeList>()) {
    // The layout's count is only the upper bound of what a set may hold: memory is taken by the set.
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                               device.capabilities().maxBindlessTextures, VK_SHADER_STAGE_ALL, nullptr};
    const VkDescriptorBindingFlags flags =
        VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT | VK_DESCRIPTOR_BINDING_UPDATE_UNUSED_WHILE_PENDING_BIT |
        VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT | VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT;
    VkDescriptorSetLayoutBindingFlagsCreateInfo flagsInfo{
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
    flagsInfo.bindingCount = 1;
    flagsInfo.pBindingFlags = &flags;
    VkDescriptorSetLayoutCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    create.pNext = &flagsInfo;
    create.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_UPDATE_AFTER_BIND_POOL_BIT;
    create.bindingCount = 1;
    create.pBindings = &binding;
    vkCheck(vkCreateDescriptorSetLayout(device.handle(), &create, nullptr, &m_layout), "vkCreateDescriptorSetLayout");
    createSet(std::max(capacity, 1u));
}

BindlessTextures::~BindlessTextures() {
    m_device.retire([device = m_device.handle(), pool = m_pool, layout = m_layout] {
        vkDestroyDescriptorPool(device, pool, nullptr);
        vkDestroyDescriptorSetLayout(device, layout, nullptr);
    });
}

void BindlessTextures::createSet(uint32_t capacity) {
    const uint32_t limit = m_device.capabilities().maxBindlessTextures;
    if (capacity > limit)
        throw DeviceError(formatText("%s holds %u textures at once, %u are needed",
                                     m_device.capabilities().deviceName.c_str(), limit, capacity));
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, capacity};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.flags = VK_DESCRIPTOR_POOL_CREATE_UPDATE_AFTER_BIND_BIT;
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    vkCheck(vkCreateDescriptorPool(m_device.handle(), &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
    // Frames in flight go on reading the old set.
    m_device.retire([device = m_device.handle(), old = m_pool] { vkDestroyDescriptorPool(device, old, nullptr); });
    m_pool = pool;

    VkDescriptorSetVariableDescriptorCountAllocateInfo variable{
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_VARIABLE_DESCRIPTOR_COUNT_ALLOCATE_INFO};
    variable.descriptorSetCount = 1;
    variable.pDescriptorCounts = &capacity;
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.pNext = &variable;
    allocate.descriptorPool = m_pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &m_layout;
    vkCheck(vkAllocateDescriptorSets(m_device.handle(), &allocate, &m_set), "vkAllocateDescriptorSets");
    const uint32_t before = m_capacity;
    m_capacity = capacity;
    m_entries.resize(capacity, m_fallback);
    m_stale = false;
    // Low indices are handed out first.
    for (uint32_t index = capacity; index-- > before;)
        m_free->indices.push_back(index);
    writeAll();
}

void BindlessTextures::writeAll() {
    std::vector<VkDescriptorImageInfo> images;
    for (const Entry& entry : m_entries)
        images.push_back({entry.sampler, entry.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = m_set;
    write.descriptorCount = m_capacity;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = images.data();
    vkUpdateDescriptorSets(m_device.handle(), 1, &write, 0, nullptr);
}

void BindlessTextures::write(uint32_t index) {
    const Entry& entry = m_entries[index];
    const VkDescriptorImageInfo image{entry.sampler, entry.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = m_set;
    write.dstArrayElement = index;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vkUpdateDescriptorSets(m_device.handle(), 1, &write, 0, nullptr);
}

uint32_t BindlessTextures::add(VkImageView view, VkSampler sampler) {
    if (m_free->indices.empty())
        createSet(std::max(m_capacity + 1, std::min(m_capacity * 2, m_device.capabilities().maxBindlessTextures)));
    const uint32_t index = m_free->indices.back();
    m_free->indices.pop_back();
    m_entries[index] = {view, sampler};
    write(index);
    return index;
}

void BindlessTextures::replace(uint32_t index, VkImageView view, VkSampler sampler) {
    m_entries.at(index) = {view, sampler};
    // A descriptor that a pending frame uses may not be rewritten: the change goes into a new set.
    m_stale = true;
}

VkDescriptorSet BindlessTextures::set() {
    if (m_stale) createSet(m_capacity);
    return m_set;
}

void BindlessTextures::remove(uint32_t index) {
    m_entries.at(index) = m_fallback;
    // The descriptor itself is rewritten when the index is used again; until then no new frame may use it.
    m_device.retire([free = m_free, index] { free->indices.push_back(index); });
}

} // namespace q3rt
