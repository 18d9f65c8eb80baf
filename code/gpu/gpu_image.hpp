#pragma once
// An image with its memory and its whole-image view.

#include <string>
#include <vector>

#include "gpu/memory.hpp"

namespace q3rt {

class Device;

struct ImageInfo {
    VkExtent2D extent{1, 1}; // pixels
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    /// Transfer source and destination are always added (if the format allows).
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    uint32_t mipCount = 1;
    uint32_t layerCount = 1; // 6 with `cube`
    bool cube = false;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    std::string name = "image";
};

/// Levels down to 1x1.
uint32_t countMips(VkExtent2D extent);
bool isDepthFormat(VkFormat format);
/// Depth of 24 bits, as OpenGL's windows have it, or of 32 where the device lacks that; 8 bits of stencil.
VkFormat depthStencilFormat(const Device& device);
VkImageAspectFlags aspectOf(VkFormat format);
/// Bytes of one texel of an uncompressed format that this code uploads or reads back; throws UsageError for others.
uint32_t texelBytes(VkFormat format);

class GpuImage {
  public:
    GpuImage() = default;
    GpuImage(Device& device, const ImageInfo& info);
    ~GpuImage() { release(); }
    GpuImage(GpuImage&& other) noexcept { *this = std::move(other); }
    GpuImage& operator=(GpuImage&& other) noexcept;

    explicit operator bool() const { return m_handle != VK_NULL_HANDLE; }
    VkImage handle() const { return m_handle; }
    VkImageView view() const { return m_view; }
    /// A view of one mip level (storage writes, mip generation); made when first asked for.
    VkImageView mipView(uint32_t mip);
    const ImageInfo& info() const { return m_info; }
    VkExtent2D extent() const { return m_info.extent; }
    VkFormat format() const { return m_info.format; }

    /// Barrier of the whole image from its current state; for code outside the frame graph (loading, tests).
    void transition(VkCommandBuffer commands, const ResourceState& next);
    /// Kept by transition() and by the frame graph.
    ResourceState state;

  private:
    void release();
    Device* m_device = nullptr;
    ImageInfo m_info;
    VkImage m_handle = VK_NULL_HANDLE;
    VkImageView m_view = VK_NULL_HANDLE;
    std::vector<VkImageView> m_mipViews;
    Allocation m_allocation;
};

} // namespace q3rt
