#pragma once
// Descriptor sets from short lists: a layout is a list of bindings, a set is a list of resources.

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

class Device;

struct Binding {
    uint32_t slot = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    VkShaderStageFlags stages = VK_SHADER_STAGE_ALL;
    uint32_t count = 1;
};

class DescriptorLayout {
  public:
    DescriptorLayout() = default;
    DescriptorLayout(Device& device, std::span<const Binding> bindings, const std::string& name = "layout");
    DescriptorLayout(Device& device, std::initializer_list<Binding> bindings, const std::string& name = "layout")
        : DescriptorLayout(device, std::span(bindings.begin(), bindings.size()), name) {}
    ~DescriptorLayout() { release(); }
    DescriptorLayout(DescriptorLayout&& other) noexcept { *this = std::move(other); }
    DescriptorLayout& operator=(DescriptorLayout&& other) noexcept;
    VkDescriptorSetLayout handle() const { return m_handle; }
    const std::vector<Binding>& bindings() const { return m_bindings; }
    uint64_t number() const { return m_number; } // of no other layout, ever: handles come again

  private:
    void release();
    Device* m_device = nullptr;
    VkDescriptorSetLayout m_handle = VK_NULL_HANDLE;
    uint64_t m_number = 0;
    std::vector<Binding> m_bindings;
};

/// One resource at one slot; made by the functions below.
struct BoundResource {
    uint32_t slot = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    uint32_t element = 0; // of an array binding
    VkDescriptorBufferInfo buffer{};
    VkDescriptorImageInfo image{};
    VkAccelerationStructureKHR acceleration = VK_NULL_HANDLE;
};
BoundResource bindStorageBuffer(uint32_t slot, VkBuffer buffer, VkDeviceSize offset = 0,
                                VkDeviceSize range = VK_WHOLE_SIZE);
BoundResource bindUniformBuffer(uint32_t slot, VkBuffer buffer, VkDeviceSize offset = 0,
                                VkDeviceSize range = VK_WHOLE_SIZE);
BoundResource bindStorageImage(uint32_t slot, VkImageView view); // layout GENERAL
BoundResource bindSampledImage(uint32_t slot, VkImageView view, VkSampler sampler,
                               VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
BoundResource bindAccelerationStructure(uint32_t slot, VkAccelerationStructureKHR acceleration);

/// Makes sets; grows pool by pool. reset() takes all its sets back, to be written anew for the same layouts: the
/// frame's arena (FrameRing::descriptors()) does that when its slot comes round; an arena of one's own holds sets for
/// good.
class DescriptorArena {
  public:
    explicit DescriptorArena(Device& device)
        : m_device(&device) {}
    ~DescriptorArena();
    DescriptorArena(const DescriptorArena&) = delete;
    DescriptorArena& operator=(const DescriptorArena&) = delete;
    VkDescriptorSet make(const DescriptorLayout& layout, std::span<const BoundResource> resources);
    VkDescriptorSet make(const DescriptorLayout& layout, std::initializer_list<BoundResource> resources) {
        return make(layout, std::span(resources.begin(), resources.size()));
    }
    void reset();

  private:
    struct Made {
        VkDescriptorSet set;
        uint64_t layout;
        bool taken;
    };
    Made* findFree(const DescriptorLayout& layout);
    VkDescriptorSet allocate(const DescriptorLayout& layout);
    void addPool(const DescriptorLayout& layout);
    Device* m_device;
    std::vector<VkDescriptorPool> m_pools; // the first m_current + 1 are in use
    size_t m_current = 0;
    std::vector<Made> m_made;
    size_t m_next = 0;      // in m_made: frames ask for much the same sets in the same order
    size_t m_takenSets = 0; // since the last reset
    int m_wastefulResets = 0;
};

/// Writes resources into an existing set (not in use by the GPU, unless the binding allows it).
void writeDescriptors(Device& device, VkDescriptorSet set, std::span<const BoundResource> resources);

} // namespace q3rt
