#include "frame/frame_executor.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "gpu/device.hpp"

namespace q3rt {
namespace {

// Frames that a transient image or buffer may lie unused before it is let go: a few seconds' change of setting.
constexpr uint64_t kIdleFrames = 120;

VkImageMemoryBarrier2 imageBarrier(VkImage image, VkFormat format, const ResourceState& from, const ResourceState& to,
                                   VkImageLayout oldLayout) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = from.stages;
    barrier.srcAccessMask = writesOf(from.access);
    barrier.dstStageMask = to.stages;
    barrier.dstAccessMask = to.access;
    barrier.oldLayout = oldLayout;
    barrier.newLayout = to.layout;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {aspectOf(format), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    return barrier;
}

VkMemoryBarrier2 memoryBarrier(const ResourceState& from, const ResourceState& to) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = from.stages;
    barrier.srcAccessMask = writesOf(from.access);
    barrier.dstStageMask = to.stages;
    barrier.dstAccessMask = to.access;
    return barrier;
}

} // namespace

ImageId FrameGraph::importImage(const char* name, GpuImage& image) {
    const ImageInfo& info = image.info();
    const ImageId id =
        importImage(name, {info.extent, info.format, info.mipCount, info.layerCount, info.samples}, image.state);
    m_resources[id.index].importedImage = &image;
    m_resources[id.index].persistent = &image.state;
    return id;
}

BufferId FrameGraph::importBuffer(const char* name, Buffer& buffer) {
    const BufferId id = importBuffer(name, buffer.state);
    m_resources[id.index].importedBuffer = &buffer;
    m_resources[id.index].bytes = buffer.size();
    m_resources[id.index].persistent = &buffer.state;
    return id;
}

void FrameExecutor::run(FrameGraph& graph, FrameRing& ring) {
    graph.compile();
    ++m_frame;
    m_boundImages.assign(graph.resources().size(), nullptr);
    m_boundBuffers.assign(graph.resources().size(), nullptr);
    for (size_t i = 0; i < graph.resources().size(); ++i) {
        m_boundImages[i] = graph.resources()[i].importedImage;
        m_boundBuffers[i] = graph.resources()[i].importedBuffer;
    }
    const VkCommandBuffer commands = ring.commands();
    PassContext context(commands, ring, graph, m_boundImages, m_boundBuffers);
    for (uint32_t i = 0; i < graph.passes().size(); ++i) {
        const GraphPass& pass = graph.passes()[i];
        if (pass.culled) continue;
        takeResources(graph, i);
        m_device.beginLabel(commands, pass.name.data());
        const uint32_t row = ring.timers().begin(commands, pass.name);
        emitBarriers(commands, graph, pass);
        if (pass.record) pass.record(context);
        ring.timers().end(commands, row);
        m_device.endLabel(commands);
        freeResources(graph, i);
    }
    for (const GraphResource& resource : graph.resources())
        if (resource.persistent && resource.firstPass != kNoResource) *resource.persistent = resource.final;
    dropUnused();
}

void FrameExecutor::takeResources(const FrameGraph& graph, uint32_t pass) {
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const GraphResource& resource = graph.resources()[i];
        if (resource.imported || resource.firstPass != pass) continue;
        if (resource.image)
            m_boundImages[i] = takeImage(resource);
        else
            m_boundBuffers[i] = takeBuffer(resource);
    }
}

GpuImage* FrameExecutor::takeImage(const GraphResource& resource) {
    for (CachedImage& cached : m_images) {
        if (cached.taken || !(cached.info == resource.info) || cached.usage != resource.imageUsage) continue;
        cached.taken = true;
        cached.lastFrame = m_frame;
        return cached.image.get();
    }
    const GraphImageInfo& info = resource.info;
    auto image = std::make_unique<GpuImage>(m_device, ImageInfo{.extent = info.extent,
                                                                .format = info.format,
                                                                .usage = resource.imageUsage,
                                                                .mipCount = info.mipCount,
                                                                .layerCount = info.layerCount,
                                                                .samples = info.samples,
                                                                .name = std::string(resource.name)});
    m_images.push_back({info, resource.imageUsage, std::move(image), m_frame, true});
    return m_images.back().image.get();
}

Buffer* FrameExecutor::takeBuffer(const GraphResource& resource) {
    for (CachedBuffer& cached : m_buffers) {
        if (cached.taken || cached.bytes != resource.bytes || cached.usage != resource.bufferUsage) continue;
        cached.taken = true;
        cached.lastFrame = m_frame;
        return cached.buffer.get();
    }
    auto buffer = std::make_unique<Buffer>(
        m_device, BufferInfo{resource.bytes, resource.bufferUsage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT,
                             MemoryDomain::DeviceLocal, std::string(resource.name)});
    m_buffers.push_back({resource.bytes, resource.bufferUsage, std::move(buffer), m_frame, true});
    return m_buffers.back().buffer.get();
}

void FrameExecutor::emitBarriers(VkCommandBuffer commands, const FrameGraph& graph, const GraphPass& pass) {
    std::vector<VkImageMemoryBarrier2>& images = m_imageBarriers;
    std::vector<VkMemoryBarrier2>& memory = m_memoryBarriers;
    images.clear();
    memory.clear();
    for (const GraphBarrier& barrier : pass.barriers) {
        const GraphResource& resource = graph.resources()[barrier.resource];
        if (resource.image) {
            GpuImage* bound = m_boundImages[barrier.resource];
            const VkImage image = bound ? bound->handle() : resource.foreignImage;
            const ResourceState& from = barrier.discard ? bound->state : barrier.from;
            const VkImageLayout oldLayout = barrier.discard ? VK_IMAGE_LAYOUT_UNDEFINED : barrier.from.layout;
            images.push_back(imageBarrier(image, resource.info.format, from, barrier.to, oldLayout));
        } else {
            const ResourceState& from = barrier.discard ? m_boundBuffers[barrier.resource]->state : barrier.from;
            if (from.stages != 0) memory.push_back(memoryBarrier(from, barrier.to));
        }
    }
    if (images.empty() && memory.empty()) return;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = static_cast<uint32_t>(images.size());
    dependency.pImageMemoryBarriers = images.data();
    dependency.memoryBarrierCount = static_cast<uint32_t>(memory.size());
    dependency.pMemoryBarriers = memory.data();
    vkCmdPipelineBarrier2KHR(commands, &dependency);
}

void FrameExecutor::freeResources(const FrameGraph& graph, uint32_t pass) {
    for (uint32_t i = 0; i < graph.resources().size(); ++i) {
        const GraphResource& resource = graph.resources()[i];
        if (resource.imported || resource.lastPass != pass) continue;
        // The next user, in this frame or a later one, waits for what was done here.
        if (resource.image) {
            m_boundImages[i]->state = resource.final;
            for (CachedImage& cached : m_images)
                if (cached.image.get() == m_boundImages[i]) cached.taken = false;
        } else {
            m_boundBuffers[i]->state = resource.final;
            for (CachedBuffer& cached : m_buffers)
                if (cached.buffer.get() == m_boundBuffers[i]) cached.taken = false;
        }
    }
}

void FrameExecutor::dropUnused() {
    // After an error inside a frame some may still be marked as taken: a new frame starts with all free.
    const auto idle = [&](auto& cached) {
        cached.taken = false;
        return cached.lastFrame + kIdleFrames < m_frame;
    };
    std::erase_if(m_images, idle);
    std::erase_if(m_buffers, idle);
}

} // namespace q3rt
