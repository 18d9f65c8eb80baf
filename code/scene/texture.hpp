#pragma once
// Textures as the engine shows them: found by name, resampled, light-scaled and mip-mapped on the CPU exactly as the
// original does (behaviour: spec of materials, section 4), ready to be uploaded by any renderer.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/file_source.hpp"
#include "math/vector.hpp"

namespace q3rt {

/// Index in TextureLibrary; also the index of the renderers' texture descriptor array.
using TextureId = uint32_t;

struct TextureFlags {
    bool mipmap = true, picmip = true, clamp = false;
};

struct MipLevel {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba; ///< empty after dropTexels()
};

struct Texture {
    std::string name;
    TextureFlags flags;
    std::vector<MipLevel> levels; ///< [0] is what is sampled closest; never empty
    bool hasAlpha = false;        ///< any alpha other than 255
    bool missing = false;         ///< stands for a file that does not exist
    uint32_t version = 0;         ///< rises when the pixels change (cinematics): upload again
    vec4 averageColor{0};         ///< mean of level 0, [0, 1]
};

struct TextureSettings {
    int picmip = 0;
    bool roundImagesDown = true, simpleMipMaps = true, colorMipLevels = false;
    int overbrightBits = 0; ///< effective: 0 in a window
    int mapOverbrightBits = 2;
    float gamma = 1.0f, intensity = 1.0f;
    bool softwareGamma = true; ///< gamma is baked into mip-mapped textures (no hardware gamma)
    float greyscale = 0.0f;
    bool lightmapIntensity = false; ///< r_lightmap 2: pages show their intensity as a hue
    int maxSize = 4096;
};

/// The always-present ids.
namespace builtinTexture {
inline constexpr TextureId kDefault = 0, kWhite = 1, kIdentityLight = 2, kDlight = 3, kFog = 4, kScratch0 = 5;
inline constexpr int kScratchCount = 32;
inline constexpr TextureId kFirstFree = kScratch0 + kScratchCount;
} // namespace builtinTexture

class TextureLibrary {
  public:
    TextureLibrary(FileSource& files, const TextureSettings& settings);
    /// By exact string; the first load decides the flags for all later users. nullopt if no file gives it.
    std::optional<TextureId> load(std::string_view name, TextureFlags flags);
    /// One 128x128 RGB lightmap page, overbright shift applied here; named "*lightmapN".
    TextureId addLightmap(int page, const uint8_t* rgb);
    /// Cinematic pixels (RGBA, top row first) into scratch slot 0..31; alpha is ignored.
    void setScratch(int slot, int width, int height, const uint8_t* rgba);
    /// Frees the pixels of a texture that is on the GPU; its sizes stay. Scratch slots keep theirs.
    void dropTexels(TextureId id);
    const Texture& get(TextureId id) const { return *m_textures[id]; }
    size_t count() const { return m_textures.size(); }
    const TextureSettings& settings() const { return m_settings; }
    /// The raw decoded mean colour of an image file (no flags, no gamma), for q3map_lightimage. nullopt if absent.
    std::optional<vec3> averageColorOf(std::string_view name);

  private:
    FileSource& m_files;
    TextureSettings m_settings;
    std::vector<std::unique_ptr<Texture>> m_textures; // ids are indexes; addresses stay
    std::unordered_map<std::string, TextureId> m_byName;
    std::unordered_map<std::string, std::optional<vec3>> m_averages;
    std::unordered_set<std::string> m_missing; ///< names that no file answered
    TextureId add(Texture texture);
    TextureId addBuiltin(std::string name, MipLevel pixels, TextureFlags flags);
};

/// Overbright shift of baked light: c << shift, scaled back by the largest channel above 255 (hue kept).
U8vec4 shiftBakedLight(U8vec4 color, int shift);

} // namespace q3rt
