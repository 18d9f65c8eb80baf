#pragma once
// Copies bytes into device-local buffers and images through a staging buffer. Uploads are batched: add many, then
// flush once (loading), or record them into the frame's commands (streaming).

#include <span>
#include <vector>

#include "gpu/buffer.hpp"
#include "gpu/gpu_image.hpp"

namespace q3rt {

class Uploader {
  public:
    /// `chunkBytes`: staging is taken in pieces of at least this size; a full piece starts another, nothing is split.
    explicit Uploader(Device& device, VkDeviceSize chunkBytes = VkDeviceSize{16} << 20);

    void upload(const Buffer& target, std::span<const std::byte> bytes, VkDeviceSize offset = 0);
    template <typename T>
    void upload(const Buffer& target, std::span<const T> items, VkDeviceSize offset = 0) {
        upload(target, std::as_bytes(items), offset);
    }
    /// One mip level of one layer, tightly packed rows, top row first. The image is sampled after flush/record.
    void upload(GpuImage& target, std::span<const std::byte> texels, uint32_t mip = 0, uint32_t layer = 0);
    /// A sub-rectangle of mip 0 (cinematics, scratch images); the rest of the image keeps its texels.
    void uploadRegion(GpuImage& target, VkOffset2D at, VkExtent2D extent, std::span<const std::byte> texels);

    /// Submits all that was added and waits until the device has it; for loading. Between frames, much staged data is
    /// flushed early, of itself.
    void flush();
    /// Records all that was added into a frame's commands, before its passes; staging is retired with the frame.
    void record(VkCommandBuffer commands);
    bool pending() const { return !m_bufferCopies.empty() || !m_imageCopies.empty(); }
    VkDeviceSize uploadedBytes() const { return m_uploadedBytes; } // since creation

  private:
    struct BufferCopy {
        VkBuffer source;
        VkBuffer target;
        VkBufferCopy region;
    };
    struct ImageCopy {
        VkBuffer source;
        GpuImage* target; // must stay where it is until flush/record
        VkBufferImageCopy region;
    };
    struct Staged {
        VkBuffer buffer;
        VkDeviceSize offset;
    };
    Staged stage(std::span<const std::byte> bytes);
    void addImageCopy(GpuImage& target, std::span<const std::byte> texels, const VkImageSubresourceLayers& layers,
                      VkOffset2D at, VkExtent2D extent);
    void recordImageCopies(VkCommandBuffer commands);

    Device& m_device;
    VkDeviceSize m_chunkBytes;
    VkDeviceSize m_uploadedBytes = 0;
    VkDeviceSize m_stagedBytes = 0; // waiting for flush/record
    std::vector<Buffer> m_chunks;
    VkDeviceSize m_chunkUsed = 0;
    std::vector<BufferCopy> m_bufferCopies;
    std::vector<ImageCopy> m_imageCopies;
};

} // namespace q3rt
