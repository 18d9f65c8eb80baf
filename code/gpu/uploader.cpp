#include "gpu/uploader.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <tuple>

#include "base/error.hpp"
#include "gpu/device.hpp"

namespace q3rt {
namespace {

constexpr ResourceState kCopyTarget{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
constexpr ResourceState kSampled{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
// Copies from buffer to image start at multiples of the texel size; 16 covers every format of texelBytes().
constexpr VkDeviceSize kStageAlignment = 16;

// Loading flushes by itself when this much is staged: a map's textures need not lie in memory twice.
constexpr VkDeviceSize kMostStagedBytes = VkDeviceSize{64} << 20;

void recordMemoryBarrier(VkCommandBuffer commands, const VkMemoryBarrier2& barrier) {
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2KHR(commands, &dependency);
}

} // namespace

Uploader::Uploader(Device& device, VkDeviceSize chunkBytes)
    : m_device(device)
    , m_chunkBytes(chunkBytes) {}

Uploader::Staged Uploader::stage(std::span<const std::byte> bytes) {
    if (m_stagedBytes + bytes.size() > kMostStagedBytes && !m_device.frameOpen()) flush();
    m_chunkUsed = (m_chunkUsed + kStageAlignment - 1) & ~(kStageAlignment - 1);
    if (m_chunks.empty() || m_chunkUsed + bytes.size() > m_chunks.back().size()) {
        m_chunks.emplace_back(m_device, BufferInfo{std::max<VkDeviceSize>(m_chunkBytes, bytes.size()),
                                                   VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryDomain::Upload, "staging"});
        m_chunkUsed = 0;
    }
    const Staged staged{m_chunks.back().handle(), m_chunkUsed};
    std::memcpy(m_chunks.back().mapped() + m_chunkUsed, bytes.data(), bytes.size());
    m_chunkUsed += bytes.size();
    m_uploadedBytes += bytes.size();
    m_stagedBytes += bytes.size();
    return staged;
}

void Uploader::upload(const Buffer& target, std::span<const std::byte> bytes, VkDeviceSize offset) {
    if (bytes.empty()) return;
    if (offset + bytes.size() > target.size())
        throw UsageError(formatText("an upload of %zu bytes at %zu doesn't fit a buffer of %zu", bytes.size(),
                                    static_cast<size_t>(offset), static_cast<size_t>(target.size())));
    const Staged staged = stage(bytes);
    m_bufferCopies.push_back({staged.buffer, target.handle(), {staged.offset, offset, bytes.size()}});
}

void Uploader::upload(GpuImage& target, std::span<const std::byte> texels, uint32_t mip, uint32_t layer) {
    const VkExtent2D extent{std::max(target.extent().width >> mip, 1u), std::max(target.extent().height >> mip, 1u)};
    addImageCopy(target, texels, {aspectOf(target.format()), mip, layer, 1}, {0, 0}, extent);
}

void Uploader::uploadRegion(GpuImage& target, VkOffset2D at, VkExtent2D extent, std::span<const std::byte> texels) {
    addImageCopy(target, texels, {aspectOf(target.format()), 0, 0, 1}, at, extent);
}

void Uploader::addImageCopy(GpuImage& target, std::span<const std::byte> texels, const VkImageSubresourceLayers& layers,
                            VkOffset2D at, VkExtent2D extent) {
    const size_t expected = size_t{extent.width} * extent.height * texelBytes(target.format());
    if (texels.size() != expected)
        throw UsageError(formatText("image \"%s\": %zu bytes given for %u x %u texels of %u bytes",
                                    target.info().name.c_str(), texels.size(), extent.width, extent.height,
                                    texelBytes(target.format())));
    if (expected == 0) return;
    const Staged staged = stage(texels);
    VkBufferImageCopy region{};
    region.bufferOffset = staged.offset;
    region.imageSubresource = layers;
    region.imageOffset = {at.x, at.y, 0};
    region.imageExtent = {extent.width, extent.height, 1};
    m_imageCopies.push_back({staged.buffer, &target, region});
}

void Uploader::recordImageCopies(VkCommandBuffer commands) {
    std::vector<GpuImage*> targets;
    for (const ImageCopy& copy : m_imageCopies)
        targets.push_back(copy.target);
    std::sort(targets.begin(), targets.end());
    targets.erase(std::unique(targets.begin(), targets.end()), targets.end());
    for (GpuImage* target : targets)
        target->transition(commands, kCopyTarget);
    // Two copies to the same texels in one batch keep their order only with a barrier between them.
    std::set<std::tuple<GpuImage*, uint32_t, uint32_t>> written; // image, mip, layer
    for (const ImageCopy& copy : m_imageCopies) {
        const VkImageSubresourceLayers& layers = copy.region.imageSubresource;
        if (!written.emplace(copy.target, layers.mipLevel, layers.baseArrayLayer).second)
            copy.target->transition(commands, kCopyTarget);
        vkCmdCopyBufferToImage(commands, copy.source, copy.target->handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                               &copy.region);
    }
    for (GpuImage* target : targets)
        target->transition(commands, kSampled);
}

void Uploader::record(VkCommandBuffer commands) {
    if (!m_bufferCopies.empty()) {
        // Earlier frames may still read or write the targets.
        VkMemoryBarrier2 before{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
        before.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        before.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
        before.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        before.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
        recordMemoryBarrier(commands, before);
        for (const BufferCopy& copy : m_bufferCopies)
            vkCmdCopyBuffer(commands, copy.source, copy.target, 1, &copy.region);
        VkMemoryBarrier2 after{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
        after.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        after.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
        after.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        after.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        recordMemoryBarrier(commands, after);
    }
    recordImageCopies(commands);
    m_bufferCopies.clear();
    m_imageCopies.clear();
    m_chunks.clear(); // retired until the frame is done
    m_chunkUsed = 0;
    m_stagedBytes = 0;
}

void Uploader::flush() {
    if (pending()) m_device.submitAndWait([this](VkCommandBuffer commands) { record(commands); });
}

} // namespace q3rt
