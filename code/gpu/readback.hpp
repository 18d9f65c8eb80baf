#pragma once
// Pixels from the GPU to the CPU: blocking for tests and screenshots, or a frame later for recordings.

#include <vector>

#include "gpu/buffer.hpp"
#include "gpu/gpu_image.hpp"

namespace q3rt {

class FrameRing;

/// What was copied before is for the CPU to see once these commands are done.
void recordHostBarrier(VkCommandBuffer commands);

/// All texels of a mip level and layer, tightly packed rows, top row first. Waits for the device.
std::vector<std::byte> readImage(Device& device, GpuImage& image, uint32_t mip = 0, uint32_t layer = 0);
/// All bytes of a buffer. Waits for the device.
std::vector<std::byte> readBuffer(Device& device, const Buffer& buffer);

/// Copy of an image made as part of a frame and collected when that frame is done.
class ImageReadback {
  public:
    ImageReadback(Device& device, uint32_t framesInFlight = 2);
    /// Records the copy; `image` (or its area `extent`) must be in TRANSFER_SRC_OPTIMAL and visible to transfer reads.
    void record(VkCommandBuffer commands, FrameRing& ring, VkImage image, VkFormat format, VkExtent2D extent);
    /// Rows of the copy recorded in frame `number`; waits for it if need be. Empty if none was recorded then.
    std::vector<std::byte> collect(FrameRing& ring, uint64_t number);

  private:
    struct Slot {
        Buffer buffer;
        uint64_t frame = 0; // 0: nothing
        VkDeviceSize bytes = 0;
    };
    Device& m_device;
    std::vector<Slot> m_slots;
};

/// The headless stand-in for a swapchain: one RGBA8 image, drawn to, then copied or read.
class OffscreenTarget {
  public:
    OffscreenTarget(Device& device, VkExtent2D extent);
    void resize(VkExtent2D extent);
    GpuImage& image() { return m_image; }
    VkExtent2D extent() const { return m_image.extent(); }
    /// RGBA8, 4 bytes a pixel, top row first. Waits for the device.
    std::vector<std::byte> readRows();

  private:
    Device& m_device;
    GpuImage m_image;
};

} // namespace q3rt
