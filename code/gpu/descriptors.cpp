#include "gpu/descriptors.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "gpu/device.hpp"

namespace q3rt {
namespace {

// Sets a pool holds at least; each further pool of an arena holds twice as many.
constexpr uint32_t kFirstPoolSets = 64;
// Resets that found a set unused, after which all are freed: those of layouts that are gone never come again.
constexpr int kWastefulResets = 240;

uint64_t nextLayoutNumber() {
    static std::atomic<uint64_t> last{0};
    return ++last;
}

} // namespace

DescriptorLayout::DescriptorLayout(Device& device, std::span<const Binding> bindings, const std::string& name)
    : m_device(&device)
    , m_number(nextLayoutNumber())
    , m_bindings(bindings.begin(), bindings.end()) {
    std::vector<VkDescriptorSetLayoutBinding> list;
    for (const Binding& binding : bindings)
        list.push_back({binding.slot, binding.type, binding.count, binding.stages, nullptr});
    VkDescriptorSetLayoutCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    create.bindingCount = static_cast<uint32_t>(list.size());
    create.pBindings = list.data();
    vkCheck(vkCreateDescriptorSetLayout(device.handle(), &create, nullptr, &m_handle), "vkCreateDescriptorSetLayout");
    device.setName(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, reinterpret_cast<uint64_t>(m_handle), name);
}

DescriptorLayout& DescriptorLayout::operator=(DescriptorLayout&& other) noexcept {
    if (this == &other) return *this;
    release();
    m_device = std::exchange(other.m_device, nullptr);
    m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
    m_number = other.m_number;
    m_bindings = std::move(other.m_bindings);
    return *this;
}

void DescriptorLayout::release() {
    if (!m_handle) return;
    m_device->retire(
        [device = m_device->handle(), handle = m_handle] { vkDestroyDescriptorSetLayout(device, handle, nullptr); });
    m_handle = VK_NULL_HANDLE;
}

BoundResource bindStorageBuffer(uint32_t slot, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize range) {
    return {.slot = slot, .type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, .buffer = {buffer, offset, range}};
}

BoundResource bindUniformBuffer(uint32_t slot, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize range) {
    return {.slot = slot, .type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, .buffer = {buffer, offset, range}};
}

BoundResource bindStorageImage(uint32_t slot, VkImageView view) {
    return {.slot = slot,
            .type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
            .image = {VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL}};
}

BoundResource bindSampledImage(uint32_t slot, VkImageView view, VkSampler sampler, VkImageLayout layout) {
    return {.slot = slot, .type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, .image = {sampler, view, layout}};
}

BoundResource bindAccelerationStructure(uint32_t slot, VkAccelerationStructureKHR acceleration) {
    return {.slot = slot, .type = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, .acceleration = acceleration};
}

void writeDescriptors(Device& device, VkDescriptorSet set, std::span<const BoundResource> resources) {
    for (const BoundResource& resource : resources) {
        const VkWriteDescriptorSetAccelerationStructureKHR acceleration{
            VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR, nullptr, 1, &resource.acceleration};
        VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = set;
        write.dstBinding = resource.slot;
        write.dstArrayElement = resource.element;
        write.descriptorCount = 1;
        write.descriptorType = resource.type;
        write.pBufferInfo = &resource.buffer;
        write.pImageInfo = &resource.image;
        if (resource.type == VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR) write.pNext = &acceleration;
        vkUpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
    }
}

DescriptorArena::~DescriptorArena() {
    m_device->retire([device = m_device->handle(), pools = std::move(m_pools)] {
        for (const VkDescriptorPool pool : pools)
            vkDestroyDescriptorPool(device, pool, nullptr);
    });
}

void DescriptorArena::addPool(const DescriptorLayout& layout) {
    const uint32_t sets = kFirstPoolSets << std::min<size_t>(m_pools.size(), 10);
    // Room for the usual kinds, and for the layout that asked whatever it is made of.
    std::vector<VkDescriptorPoolSize> sizes{{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, sets * 4},
                                            {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, sets * 2},
                                            {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, sets * 4},
                                            {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, sets * 4}};
    if (m_device->capabilities().accelerationStructure)
        sizes.push_back({VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, sets});
    for (const Binding& binding : layout.bindings()) {
        const auto same =
            std::find_if(sizes.begin(), sizes.end(), [&](const auto& s) { return s.type == binding.type; });
        if (same == sizes.end())
            sizes.push_back({binding.type, binding.count * sets});
        else
            same->descriptorCount += binding.count;
    }
    VkDescriptorPoolCreateInfo create{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    create.maxSets = sets;
    create.poolSizeCount = static_cast<uint32_t>(sizes.size());
    create.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    vkCheck(vkCreateDescriptorPool(m_device->handle(), &create, nullptr, &pool), "vkCreateDescriptorPool");
    m_pools.push_back(pool);
}

DescriptorArena::Made* DescriptorArena::findFree(const DescriptorLayout& layout) {
    if (m_takenSets == m_made.size()) return nullptr;
    for (size_t i = 0; i < m_made.size(); ++i) {
        Made& made = m_made[(m_next + i) % m_made.size()];
        if (!made.taken && made.layout == layout.number()) return &made;
    }
    return nullptr;
}

VkDescriptorSet DescriptorArena::make(const DescriptorLayout& layout, std::span<const BoundResource> resources) {
    Made* made = findFree(layout);
    if (!made) made = &m_made.emplace_back(Made{allocate(layout), layout.number(), false});
    made->taken = true;
    m_next = static_cast<size_t>(made - m_made.data()) + 1;
    ++m_takenSets;
    writeDescriptors(*m_device, made->set, resources);
    return made->set;
}

VkDescriptorSet DescriptorArena::allocate(const DescriptorLayout& layout) {
    const VkDescriptorSetLayout handle = layout.handle();
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorSetCount = 1;
    info.pSetLayouts = &handle;
    VkDescriptorSet set = VK_NULL_HANDLE;
    for (;; ++m_current) {
        const bool fresh = m_current == m_pools.size();
        if (fresh) addPool(layout);
        info.descriptorPool = m_pools[m_current];
        const VkResult result = vkAllocateDescriptorSets(m_device->handle(), &info, &set);
        if (result == VK_SUCCESS) break;
        // A full pool is passed over; a fresh one that fails is an error.
        const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
        if (fresh || !full) vkCheck(result, "vkAllocateDescriptorSets");
    }
    return set;
}

void DescriptorArena::reset() {
    m_wastefulResets = m_takenSets < m_made.size() ? m_wastefulResets + 1 : 0;
    for (Made& made : m_made)
        made.taken = false;
    m_next = m_takenSets = 0;
    if (m_wastefulResets < kWastefulResets) return;
    m_wastefulResets = 0;
    m_made.clear();
    m_current = 0;
    for (const VkDescriptorPool pool : m_pools)
        vkCheck(vkResetDescriptorPool(m_device->handle(), pool, 0), "vkResetDescriptorPool");
}

} // namespace q3rt
