#include "gpu/gpu_image.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/error.hpp"
#include "gpu/device.hpp"

namespace q3rt {
namespace {

VkImageView createView(Device& device, VkImage image, const ImageInfo& info, uint32_t firstMip, uint32_t mipCount,
                       bool single) {
    VkImageViewCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    create.image = image;
    create.viewType = info.cube && !single  ? VK_IMAGE_VIEW_TYPE_CUBE
                      : info.layerCount > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                            : VK_IMAGE_VIEW_TYPE_2D;
    create.format = info.format;
    create.subresourceRange = {aspectOf(info.format), firstMip, mipCount, 0, info.layerCount};
    // Sampling or storing takes one aspect: of depth with stencil, the depth.
    constexpr VkImageUsageFlags kShaderUses = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
    if (isDepthFormat(info.format) && (info.usage & kShaderUses))
        create.subresourceRange.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
    VkImageView view = VK_NULL_HANDLE;
    vkCheck(vkCreateImageView(device.handle(), &create, nullptr, &view), "vkCreateImageView");
    return view;
}

/// Vulkan only promises a few formats for each usage.
void checkFormat(const Device& device, const VkImageCreateInfo& create, const std::string& name) {
    VkImageFormatProperties properties;
    const VkResult result = vkGetPhysicalDeviceImageFormatProperties(
        device.physical(), create.format, create.imageType, create.tiling, create.usage, create.flags, &properties);
    if (result == VK_ERROR_FORMAT_NOT_SUPPORTED)
        throw DeviceError(formatText("%s can't make image \"%s\" (format %d, usage 0x%x): choose another device",
                                     device.capabilities().deviceName.c_str(), name.c_str(),
                                     static_cast<int>(create.format), create.usage));
    vkCheck(result, "vkGetPhysicalDeviceImageFormatProperties");
}

} // namespace

uint32_t countMips(VkExtent2D extent) {
    return static_cast<uint32_t>(std::bit_width(std::max(extent.width, extent.height)));
}

bool isDepthFormat(VkFormat format) { return format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT_S8_UINT; }

VkFormat depthStencilFormat(const Device& device) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(device.physical(), VK_FORMAT_D24_UNORM_S8_UINT, &properties);
    const bool has24 = properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
    return has24 ? VK_FORMAT_D24_UNORM_S8_UINT : VK_FORMAT_D32_SFLOAT_S8_UINT; // one of the two is always there
}

VkImageAspectFlags aspectOf(VkFormat format) {
    switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
        return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_S8_UINT:
        return VK_IMAGE_ASPECT_STENCIL_BIT;
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
        return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
        return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

uint32_t texelBytes(VkFormat format) {
    switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R8_UINT:
        return 1;
    case VK_FORMAT_R8G8_UNORM:
    case VK_FORMAT_R16_UINT:
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_D16_UNORM:
        return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
    case VK_FORMAT_E5B9G9R9_UFLOAT_PACK32:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R16G16_SNORM:
    case VK_FORMAT_R16G16_UNORM:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SINT:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT:
        return 4;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SFLOAT:
        return 8;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return 16;
    default:
        throw UsageError(formatText("format %d can be neither uploaded nor read back", static_cast<int>(format)));
    }
}

GpuImage::GpuImage(Device& device, const ImageInfo& info)
    : m_device(&device)
    , m_info(info) {
    if (info.extent.width == 0 || info.extent.height == 0)
        throw UsageError(formatText("image \"%s\" has no pixels", info.name.c_str()));
    const VkPhysicalDeviceLimits& limits = device.capabilities().limits;
    const uint32_t largest = info.cube ? limits.maxImageDimensionCube : limits.maxImageDimension2D;
    if (std::max(info.extent.width, info.extent.height) > largest)
        throw UsageError(formatText("image \"%s\" is %u x %u: this device takes up to %u", info.name.c_str(),
                                    info.extent.width, info.extent.height, largest));
    VkImageCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    create.flags = info.cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = info.format;
    create.extent = {info.extent.width, info.extent.height, 1};
    create.mipLevels = info.mipCount;
    create.arrayLayers = info.layerCount;
    create.samples = info.samples;
    create.usage = info.usage;
    if (info.samples == VK_SAMPLE_COUNT_1_BIT)
        create.usage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    checkFormat(device, create, info.name);
    vkCheck(vkCreateImage(device.handle(), &create, nullptr, &m_handle), "vkCreateImage");
    try {
        VkMemoryRequirements needs;
        vkGetImageMemoryRequirements(device.handle(), m_handle, &needs);
        m_allocation = device.memory().allocate(needs, MemoryDomain::DeviceLocal, false);
        vkCheck(vkBindImageMemory(device.handle(), m_handle, m_allocation.memory, m_allocation.offset),
                "vkBindImageMemory");
        device.setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(m_handle), info.name);
        constexpr VkImageUsageFlags kViewUses = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        if (info.usage & kViewUses) m_view = createView(device, m_handle, info, 0, info.mipCount, false);
    } catch (...) {
        release();
        throw;
    }
}

GpuImage& GpuImage::operator=(GpuImage&& other) noexcept {
    if (this == &other) return *this;
    release();
    m_device = std::exchange(other.m_device, nullptr);
    m_info = std::move(other.m_info);
    m_handle = std::exchange(other.m_handle, VK_NULL_HANDLE);
    m_view = std::exchange(other.m_view, VK_NULL_HANDLE);
    m_mipViews = std::exchange(other.m_mipViews, {});
    m_allocation = std::exchange(other.m_allocation, {});
    state = std::exchange(other.state, {});
    return *this;
}

VkImageView GpuImage::mipView(uint32_t mip) {
    m_mipViews.resize(m_info.mipCount, VK_NULL_HANDLE);
    if (!m_mipViews.at(mip)) m_mipViews[mip] = createView(*m_device, m_handle, m_info, mip, 1, true);
    return m_mipViews[mip];
}

void GpuImage::transition(VkCommandBuffer commands, const ResourceState& next) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = state.stages;
    barrier.srcAccessMask = state.access;
    barrier.dstStageMask = next.stages;
    barrier.dstAccessMask = next.access;
    barrier.oldLayout = state.layout;
    barrier.newLayout = next.layout;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = m_handle;
    barrier.subresourceRange = {aspectOf(m_info.format), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2KHR(commands, &dependency);
    state = next;
}

void GpuImage::release() {
    if (!m_handle) return;
    m_device->retire(
        [device = m_device, handle = m_handle, view = m_view, mips = std::move(m_mipViews), allocation = m_allocation] {
            for (const VkImageView mip : mips)
                vkDestroyImageView(device->handle(), mip, nullptr);
            vkDestroyImageView(device->handle(), view, nullptr);
            vkDestroyImage(device->handle(), handle, nullptr);
            device->memory().free(allocation);
        });
    m_handle = VK_NULL_HANDLE;
    m_view = VK_NULL_HANDLE;
    m_mipViews.clear();
    m_allocation = {};
}

} // namespace q3rt
