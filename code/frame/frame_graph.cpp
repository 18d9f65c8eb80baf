#include "frame/frame_graph.hpp"

#include "base/error.hpp"

namespace q3rt {

void PassBuilder::read(ImageId image, const Access& how) {
    m_graph.use(m_pass, image.index, image.version, how, false);
}

void PassBuilder::read(BufferId buffer, const Access& how) {
    m_graph.use(m_pass, buffer.index, buffer.version, how, false);
}

ImageId PassBuilder::write(ImageId image, const Access& how) {
    return {image.index, m_graph.use(m_pass, image.index, image.version, how, true)};
}

BufferId PassBuilder::write(BufferId buffer, const Access& how) {
    return {buffer.index, m_graph.use(m_pass, buffer.index, buffer.version, how, true)};
}

ImageId PassBuilder::create(const char* name, const GraphImageInfo& info, const Access& how) {
    GraphResource resource;
    resource.name = m_graph.keepName(name);
    resource.info = info;
    const uint32_t index = m_graph.addResource(std::move(resource));
    const ImageId made = write(ImageId{index, 0}, how);
    m_graph.m_passes[m_pass].uses.back().fresh = true;
    return made;
}

BufferId PassBuilder::create(const char* name, VkDeviceSize bytes, const Access& how) {
    GraphResource resource;
    resource.name = m_graph.keepName(name);
    resource.image = false;
    resource.bytes = bytes;
    const uint32_t index = m_graph.addResource(std::move(resource));
    const BufferId made = write(BufferId{index, 0}, how);
    m_graph.m_passes[m_pass].uses.back().fresh = true;
    return made;
}

void PassBuilder::keep() { m_graph.m_passes[m_pass].kept = true; }

PassBuilder FrameGraph::beginPass(const char* name) {
    if (m_compiled) throw UsageError(formatText("pass \"%s\" is added to a compiled frame", name));
    m_passes.emplace_back(m_memory).name = keepName(name);
    return PassBuilder(*this, static_cast<uint32_t>(m_passes.size() - 1));
}

std::string_view FrameGraph::keepName(const char* name) { return m_names.emplace_back(name); }

uint32_t FrameGraph::addResource(GraphResource resource) {
    resource.final = resource.initial;
    m_resources.push_back(std::move(resource));
    return static_cast<uint32_t>(m_resources.size() - 1);
}

ImageId FrameGraph::importImage(const char* name, const GraphImageInfo& info, const ResourceState& initial) {
    GraphResource resource;
    resource.name = keepName(name);
    resource.info = info;
    resource.imported = true;
    resource.initial = initial;
    return {addResource(std::move(resource)), 0};
}

BufferId FrameGraph::importBuffer(const char* name, const ResourceState& initial) {
    GraphResource resource;
    resource.name = keepName(name);
    resource.image = false;
    resource.imported = true;
    resource.initial = initial;
    return {addResource(std::move(resource)), 0};
}

BufferId FrameGraph::importToken(const char* name, ResourceState& state) {
    const BufferId id = importBuffer(name, state);
    m_resources[id.index].persistent = &state;
    return id;
}

ImageId FrameGraph::importForeign(const char* name, VkImage image, VkImageView view, const GraphImageInfo& info) {
    // Its acquisition is waited for by all commands of the submission; the first barrier must start after that wait.
    const ResourceState acquired{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED};
    const ImageId id = importImage(name, info, acquired);
    m_resources[id.index].foreignImage = image;
    m_resources[id.index].foreignView = view;
    return id;
}

const GraphImageInfo& FrameGraph::info(ImageId image) const {
    if (image.index >= m_resources.size() || !m_resources[image.index].image)
        throw UsageError("the frame is asked for an image that it doesn't have");
    return m_resources[image.index].info;
}

uint32_t FrameGraph::use(uint32_t pass, uint32_t resource, uint32_t version, const Access& how, bool write) {
    GraphPass& user = m_passes[pass];
    if (resource >= m_resources.size())
        throw UsageError(formatText("pass \"%s\" uses a resource that was never made", user.name.data()));
    GraphResource& used = m_resources[resource];
    if (version != used.version)
        throw UsageError(
            formatText("pass \"%s\" uses version %u of \"%s\", which pass order has already replaced by %u",
                       user.name.data(), version, used.name.data(), used.version));
    if (write && !isWrite(how.access))
        throw UsageError(
            formatText("pass \"%s\" writes \"%s\" with an access that only reads", user.name.data(), used.name.data()));
    if (used.image && how.layout == VK_IMAGE_LAYOUT_UNDEFINED)
        throw UsageError(
            formatText("pass \"%s\" uses image \"%s\" without a layout", user.name.data(), used.name.data()));
    for (const GraphUse& other : user.uses)
        if (other.resource == resource && used.image && other.how.layout != how.layout)
            throw UsageError(formatText("pass \"%s\" wants image \"%s\" in two layouts at once", user.name.data(),
                                        used.name.data()));
    if (write) ++used.version;
    user.uses.push_back({resource, write ? used.version : version, how, write, false});
    return used.version;
}

} // namespace q3rt
