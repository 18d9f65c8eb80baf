#include "base/error.hpp"
#include "frame/frame_executor.hpp"

namespace q3rt {

Device& PassContext::device() const { return m_ring.device(); }

VkDescriptorSet PassContext::makeSet(const DescriptorLayout& layout,
                                     std::initializer_list<BoundResource> resources) const {
    return m_ring.descriptors().make(layout, resources);
}

const GraphResource& PassContext::imageResource(ImageId image) const {
    if (image.index >= m_graph.resources().size() || !m_graph.resources()[image.index].image)
        throw UsageError(
            "a pass asks for an image that the frame doesn't have (a handle made in declare reaches record as "
            "its argument, not by capture)");
    return m_graph.resources()[image.index];
}

GpuImage& PassContext::boundImage(ImageId image) const {
    const GraphResource& resource = imageResource(image);
    if (!m_images[image.index])
        throw UsageError(formatText("image \"%s\" is used outside its life in the frame", resource.name.data()));
    return *m_images[image.index];
}

VkImage PassContext::image(ImageId image) const {
    const GraphResource& resource = imageResource(image);
    return resource.foreignImage ? resource.foreignImage : boundImage(image).handle();
}

VkImageView PassContext::view(ImageId image) const {
    const GraphResource& resource = imageResource(image);
    return resource.foreignView ? resource.foreignView : boundImage(image).view();
}

VkImageView PassContext::mipView(ImageId image, uint32_t mip) const { return boundImage(image).mipView(mip); }

VkExtent2D PassContext::extent(ImageId image) const { return imageResource(image).info.extent; }

VkFormat PassContext::format(ImageId image) const { return imageResource(image).info.format; }

const Buffer& PassContext::boundBuffer(BufferId buffer) const {
    if (buffer.index >= m_buffers.size() || !m_buffers[buffer.index])
        throw UsageError("a pass asks for a buffer that the frame doesn't have");
    return *m_buffers[buffer.index];
}

VkBuffer PassContext::buffer(BufferId buffer) const { return boundBuffer(buffer).handle(); }

VkDeviceAddress PassContext::address(BufferId buffer) const { return boundBuffer(buffer).address(); }

} // namespace q3rt
