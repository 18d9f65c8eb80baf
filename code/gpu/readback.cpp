#include "gpu/readback.hpp"

#include <algorithm>
#include <cstring>

#include "gpu/device.hpp"
#include "gpu/frame_ring.hpp"

namespace q3rt {
namespace {

constexpr ResourceState kCopySource{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};

VkBufferImageCopy wholeLevel(VkFormat format, VkExtent2D extent, uint32_t mip, uint32_t layer) {
    VkBufferImageCopy region{};
    const VkImageAspectFlags aspect =
        isDepthFormat(format) ? VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT} : aspectOf(format);
    region.imageSubresource = {aspect, mip, layer, 1};
    region.imageExtent = {extent.width, extent.height, 1};
    return region;
}

std::vector<std::byte> copyOut(const Buffer& buffer, VkDeviceSize bytes) {
    return {buffer.mapped(), buffer.mapped() + bytes};
}

} // namespace

void recordHostBarrier(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2KHR(commands, &dependency);
}

std::vector<std::byte> readImage(Device& device, GpuImage& image, uint32_t mip, uint32_t layer) {
    const VkExtent2D extent{std::max(image.extent().width >> mip, 1u), std::max(image.extent().height >> mip, 1u)};
    const VkDeviceSize bytes = VkDeviceSize{extent.width} * extent.height * texelBytes(image.format());
    const Buffer staging(device, {bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryDomain::Readback, "readback"});
    const VkBufferImageCopy region = wholeLevel(image.format(), extent, mip, layer);
    const ResourceState before = image.state;
    device.submitAndWait([&](VkCommandBuffer commands) {
        image.transition(commands, kCopySource);
        vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.handle(), 1,
                               &region);
        recordHostBarrier(commands);
        // Descriptors may name the layout that it had.
        if (before.layout != VK_IMAGE_LAYOUT_UNDEFINED) image.transition(commands, before);
    });
    return copyOut(staging, bytes);
}

std::vector<std::byte> readBuffer(Device& device, const Buffer& buffer) {
    const Buffer staging(device, {buffer.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryDomain::Readback, "readback"});
    device.submitAndWait([&](VkCommandBuffer commands) {
        VkMemoryBarrier2 before{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
        before.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        before.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
        before.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        before.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
        VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        dependency.memoryBarrierCount = 1;
        dependency.pMemoryBarriers = &before;
        vkCmdPipelineBarrier2KHR(commands, &dependency);
        const VkBufferCopy region{0, 0, buffer.size()};
        vkCmdCopyBuffer(commands, buffer.handle(), staging.handle(), 1, &region);
        recordHostBarrier(commands);
    });
    return copyOut(staging, buffer.size());
}

ImageReadback::ImageReadback(Device& device, uint32_t framesInFlight)
    : m_device(device)
    , m_slots(framesInFlight) {}

void ImageReadback::record(VkCommandBuffer commands, FrameRing& ring, VkImage image, VkFormat format,
                           VkExtent2D extent) {
    Slot& slot = m_slots.at(ring.slot());
    slot.bytes = VkDeviceSize{extent.width} * extent.height * texelBytes(format);
    if (slot.buffer.size() < slot.bytes)
        slot.buffer =
            Buffer(m_device, {slot.bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryDomain::Readback, "readback"});
    slot.frame = ring.frameNumber();
    const VkBufferImageCopy region = wholeLevel(format, extent, 0, 0);
    vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, slot.buffer.handle(), 1, &region);
    recordHostBarrier(commands);
}

std::vector<std::byte> ImageReadback::collect(FrameRing& ring, uint64_t number) {
    for (const Slot& slot : m_slots) {
        if (slot.frame != number || number == 0) continue;
        ring.wait(number);
        return copyOut(slot.buffer, slot.bytes);
    }
    return {};
}

OffscreenTarget::OffscreenTarget(Device& device, VkExtent2D extent)
    : m_device(device) {
    resize(extent);
}

void OffscreenTarget::resize(VkExtent2D extent) {
    if (m_image && m_image.extent().width == extent.width && m_image.extent().height == extent.height) return;
    m_image = GpuImage(m_device, {.extent = extent,
                                  .format = VK_FORMAT_R8G8B8A8_UNORM,
                                  .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                           VK_IMAGE_USAGE_SAMPLED_BIT,
                                  .name = "offscreen target"});
}

std::vector<std::byte> OffscreenTarget::readRows() { return readImage(m_device, m_image); }

} // namespace q3rt
