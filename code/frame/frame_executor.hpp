#pragma once
// Runs a compiled FrameGraph: makes or reuses transient resources, emits the barriers, wraps each pass in a debug label
// and a GPU timer.

#include <memory>
#include <vector>

#include "frame/frame_graph.hpp"
#include "gpu/buffer.hpp"
#include "gpu/frame_ring.hpp"
#include "gpu/gpu_image.hpp"

namespace q3rt {

/// Handed to `record`.
class PassContext {
  public:
    VkCommandBuffer commands() const { return m_commands; }
    Device& device() const;
    FrameRing& ring() const { return m_ring; }
    /// Sets that live as long as the frame.
    VkDescriptorSet makeSet(const DescriptorLayout& layout, std::initializer_list<BoundResource> resources) const;
    VkImage image(ImageId image) const;
    VkImageView view(ImageId image) const;
    VkImageView mipView(ImageId image, uint32_t mip) const; // transient and imported images
    VkExtent2D extent(ImageId image) const;
    VkFormat format(ImageId image) const;
    VkBuffer buffer(BufferId buffer) const;
    VkDeviceAddress address(BufferId buffer) const;

  private:
    friend class FrameExecutor;
    PassContext(VkCommandBuffer commands, FrameRing& ring, const FrameGraph& graph,
                const std::vector<GpuImage*>& images, const std::vector<Buffer*>& buffers)
        : m_commands(commands)
        , m_ring(ring)
        , m_graph(graph)
        , m_images(images)
        , m_buffers(buffers) {}
    const GraphResource& imageResource(ImageId image) const;
    GpuImage& boundImage(ImageId image) const;
    const Buffer& boundBuffer(BufferId buffer) const;
    VkCommandBuffer m_commands;
    FrameRing& m_ring;
    const FrameGraph& m_graph;
    const std::vector<GpuImage*>& m_images;
    const std::vector<Buffer*>& m_buffers;
};

class FrameExecutor {
  public:
    explicit FrameExecutor(Device& device)
        : m_device(device) {}

    /// Compiles if need be and records every pass into the ring's open command buffer. Imported states are written
    /// back.
    void run(FrameGraph& graph, FrameRing& ring);
    /// Transient images and buffers now held; those unused for some frames are let go.
    size_t cachedCount() const { return m_images.size() + m_buffers.size(); }

  private:
    struct CachedImage {
        GraphImageInfo info;
        VkImageUsageFlags usage;
        std::unique_ptr<GpuImage> image;
        uint64_t lastFrame = 0;
        bool taken = false;
    };
    struct CachedBuffer {
        VkDeviceSize bytes;
        VkBufferUsageFlags usage;
        std::unique_ptr<Buffer> buffer;
        uint64_t lastFrame = 0;
        bool taken = false;
    };
    GpuImage* takeImage(const GraphResource& resource);
    Buffer* takeBuffer(const GraphResource& resource);
    void emitBarriers(VkCommandBuffer commands, const FrameGraph& graph, const GraphPass& pass);
    void takeResources(const FrameGraph& graph, uint32_t pass);
    void freeResources(const FrameGraph& graph, uint32_t pass);
    void dropUnused();

    Device& m_device;
    std::vector<CachedImage> m_images;
    std::vector<CachedBuffer> m_buffers;
    uint64_t m_frame = 0;
    std::vector<GpuImage*> m_boundImages; // by resource index, while running
    std::vector<Buffer*> m_boundBuffers;
    std::vector<VkImageMemoryBarrier2> m_imageBarriers; // of the pass at hand
    std::vector<VkMemoryBarrier2> m_memoryBarriers;
};

} // namespace q3rt
