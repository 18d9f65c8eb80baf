#include "renderer_vk/texture_store.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"
#include "gpu/device.hpp"
#include "gpu/sampler.hpp"

namespace q3rt {

TextureStore::TextureStore(Device& device)
    : m_device(device) {
    m_fallback = GpuImage(device, {.extent = {1, 1}, .name = "texture fallback"});
    Uploader uploader(device, 256);
    const std::array<uint8_t, 4> white = {255, 255, 255, 255};
    uploader.upload(m_fallback, std::as_bytes(std::span(white)));
    uploader.flush();
    m_bindless = std::make_unique<BindlessTextures>(m_device, m_fallback.view(), m_device.samplers().find({}));
}

void TextureStore::reset() {
    // The GPU is idle, so the slots are free at once; given back from the last to the first, they come in order again.
    for (uint32_t slot = static_cast<uint32_t>(m_entries.size()); slot-- > 0;)
        m_bindless->remove(slot);
    m_entries.clear();
    m_parts.clear();
}

VkSampler TextureStore::samplerOf(const Texture& texture) const {
    SamplerInfo info;
    if (texture.flags.clamp) info.addressU = info.addressV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    if (!texture.flags.mipmap) {
        info.maxLod = 0;
        return m_device.samplers().find(info);
    }
    const std::string& mode = m_filter.mode;
    const bool nearestTexel = mode.starts_with("GL_NEAREST");
    info.magFilter = info.minFilter = nearestTexel ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    info.mipmapMode = mode.ends_with("MIPMAP_NEAREST") ? VK_SAMPLER_MIPMAP_MODE_NEAREST : VK_SAMPLER_MIPMAP_MODE_LINEAR;
    if (mode.find("MIPMAP") == std::string::npos) info.maxLod = 0;
    info.maxAnisotropy = m_filter.anisotropy;
    return m_device.samplers().find(info);
}

void TextureStore::create(const Texture& texture, Entry& entry, Uploader& uploader) {
    const MipLevel& base = texture.levels.front();
    ImageInfo info;
    info.extent = {static_cast<uint32_t>(base.width), static_cast<uint32_t>(base.height)};
    info.mipCount = static_cast<uint32_t>(texture.levels.size());
    info.name = texture.name;
    entry.image = std::make_unique<GpuImage>(m_device, info);
    for (uint32_t level = 0; level < info.mipCount; ++level)
        uploader.upload(*entry.image, std::as_bytes(std::span(texture.levels[level].rgba)), level);
    entry.version = texture.version;
}

void TextureStore::follow(TextureLibrary& library, const TextureFilter& filter, bool keepTexels, Uploader& uploader) {
    const bool filterChanged = !(filter == m_filter);
    m_filter = filter;
    const auto known = static_cast<TextureId>(m_entries.size());
    for (TextureId id = known; id < library.count(); ++id) {
        const Texture& texture = library.get(id);
        m_entries.emplace_back();
        create(texture, m_entries[id], uploader);
        const bool changes = id >= builtinTexture::kScratch0 && id < builtinTexture::kFirstFree;
        m_parts.push_back(changes ? TextureParts{} : findTextureParts(texture));
        if (!keepTexels) library.dropTexels(id);
        if (m_bindless->add(m_entries[id].image->view(), samplerOf(texture)) != id)
            throw DeviceError("texture slots are out of order: restart the renderer with vid_restart");
    }
    // Pixels change in scratch slots alone.
    for (TextureId id = builtinTexture::kScratch0; id < std::min(builtinTexture::kFirstFree, known); ++id)
        followPixels(library.get(id), id, uploader);
    for (TextureId id = 0; filterChanged && id < known; ++id)
        m_bindless->replace(id, m_entries[id].image->view(), samplerOf(library.get(id)));
}

void TextureStore::followPixels(const Texture& texture, TextureId id, Uploader& uploader) {
    Entry& entry = m_entries[id];
    if (entry.version == texture.version) return;
    const MipLevel& base = texture.levels.front();
    const VkExtent2D extent = {static_cast<uint32_t>(base.width), static_cast<uint32_t>(base.height)};
    if (entry.image->extent().width == extent.width && entry.image->extent().height == extent.height) {
        uploader.uploadRegion(*entry.image, {0, 0}, extent, std::as_bytes(std::span(base.rgba)));
        entry.version = texture.version;
    } else {
        create(texture, entry, uploader);
        m_bindless->replace(id, entry.image->view(), samplerOf(texture));
    }
}

} // namespace q3rt
