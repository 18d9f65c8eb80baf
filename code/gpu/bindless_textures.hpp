#pragma once
// All textures of a renderer in one descriptor array of combined image samplers: set layout binding 0,
// `layout(set = N, binding = 0) uniform sampler2D textures[];`. Grows; an index never moves.

#include <memory>
#include <vector>

#include "gpu/vulkan_api.hpp"

namespace q3rt {

class Device;

class BindlessTextures {
  public:
    /// `fallback` fills every free slot, so a stale index shows it and not rubbish.
    BindlessTextures(Device& device, VkImageView fallback, VkSampler fallbackSampler, uint32_t capacity = 1024);
    ~BindlessTextures();
    BindlessTextures(const BindlessTextures&) = delete;
    BindlessTextures& operator=(const BindlessTextures&) = delete;

    uint32_t add(VkImageView view, VkSampler sampler);
    /// Shows another image under the same index from the next recorded frame on.
    void replace(uint32_t index, VkImageView view, VkSampler sampler);
    /// The index is handed out again once the frames that use it are done.
    void remove(uint32_t index);

    VkDescriptorSetLayout layout() const { return m_layout; } // stays the same
    /// Ask when recording: growth and replacements make a new one, all those since the last call together.
    VkDescriptorSet set();
    uint32_t capacity() const { return m_capacity; }

  private:
    struct Entry {
        VkImageView view;
        VkSampler sampler;
    };
    void createSet(uint32_t capacity);
    void write(uint32_t index);
    void writeAll();

    Device& m_device;
    Entry m_fallback;
    VkDescriptorSetLayout m_layout = VK_NULL_HANDLE;
    VkDescriptorPool m_pool = VK_NULL_HANDLE;
    VkDescriptorSet m_set = VK_NULL_HANDLE;
    uint32_t m_capacity = 0;
    bool m_stale = false; ///< entries were replaced: the next set() shows them
    std::vector<Entry> m_entries;
    struct FreeList;
    std::shared_ptr<FreeList> m_free; // shared with retired removals, which may outlive this
};

} // namespace q3rt
