#pragma once
// The texture library on the GPU: index of the bindless array = TextureId.

#include <memory>
#include <string>
#include <vector>

#include "gpu/bindless_textures.hpp"
#include "gpu/gpu_image.hpp"
#include "gpu/uploader.hpp"
#include "scene/effect_trim.hpp"
#include "scene/texture.hpp"

namespace q3rt {

/// How mip-mapped textures are filtered.
struct TextureFilter {
    std::string mode = "GL_LINEAR_MIPMAP_LINEAR"; ///< r_textureMode
    float anisotropy = 1;
    bool operator==(const TextureFilter&) const = default;
};

class TextureStore {
  public:
    explicit TextureStore(Device& device);
    /// Forgets all textures (a new library follows). The GPU must be idle.
    void reset();
    /// Uploads textures that are new or whose version rose, into `uploader` (the caller flushes or records it).
    /// Their pixels leave the library unless `keepTexels`.
    void follow(TextureLibrary& library, const TextureFilter& filter, bool keepTexels, Uploader& uploader);
    VkDescriptorSetLayout layout() const { return m_bindless->layout(); }
    VkDescriptorSet set() const { return m_bindless->set(); } ///< ask while recording
    size_t count() const { return m_entries.size(); }
    /// Where each shows.
    std::span<const TextureParts> parts() const { return m_parts; }

  private:
    struct Entry {
        std::unique_ptr<GpuImage> image; // uploads keep its address
        uint32_t version = 0;
    };
    VkSampler samplerOf(const Texture& texture) const;
    void create(const Texture& texture, Entry& entry, Uploader& uploader);
    void followPixels(const Texture& texture, TextureId id, Uploader& uploader);

    Device& m_device;
    TextureFilter m_filter;
    GpuImage m_fallback;
    std::unique_ptr<BindlessTextures> m_bindless;
    std::vector<Entry> m_entries;
    std::vector<TextureParts> m_parts; // by id
};

} // namespace q3rt
