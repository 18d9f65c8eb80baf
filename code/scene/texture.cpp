// The texture cache and the search for image files (spec of materials, section 1.7).
#include "scene/texture.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/log.hpp"
#include "formats/image.hpp"
#include "formats/text_case.hpp"
#include "scene/texture_upload.hpp"

namespace q3rt {
namespace {

constexpr std::array<std::string_view, 6> kExtensions = {"tga", "jpg", "jpeg", "png", "pcx", "bmp"};
constexpr size_t kMaxImageName = 63; ///< of the engine's file system

struct SplitName {
    std::string_view stem, extension;
};

/// Extension: after the last dot, if that lies after the last slash.
SplitName splitExtension(std::string_view name) {
    const size_t dot = name.rfind('.'), slash = name.rfind('/');
    if (dot == std::string_view::npos || (slash != std::string_view::npos && dot < slash)) return {name, {}};
    return {name.substr(0, dot), name.substr(dot + 1)};
}

/// One candidate file; a damaged one is a warning and counts as absent.
std::optional<Image> tryImage(FileSource& files, const std::string& path) {
    const auto bytes = files.read(path);
    if (!bytes) return std::nullopt;
    try {
        Image image = decodeImage(*bytes, path);
        if (image.width > 0 && image.height > 0) return image;
        logLineOnce(LogLevel::Warning, "%s: image has no pixels; replace the file", path.c_str());
    } catch (const ContentError& error) {
        logLineOnce(LogLevel::Warning, "%s", error.what());
    }
    return std::nullopt;
}

std::optional<Image> findImage(FileSource& files, std::string_view name) {
    const SplitName split = splitExtension(name);
    std::string_view stem = name, tried;
    for (const std::string_view extension : kExtensions)
        if (equalsIgnoringCase(extension, split.extension)) {
            if (auto image = tryImage(files, std::string(name))) return image;
            stem = split.stem;
            tried = extension;
        }
    for (const std::string_view extension : kExtensions) {
        if (extension == tried) continue;
        if (auto image = tryImage(files, std::string(stem) + "." + std::string(extension))) return image;
    }
    return std::nullopt;
}

bool anyTransparent(const std::vector<uint8_t>& rgba) {
    for (size_t i = 3; i < rgba.size(); i += 4)
        if (rgba[i] != 255) return true;
    return false;
}

} // namespace

TextureLibrary::TextureLibrary(FileSource& files, const TextureSettings& settings)
    : m_files(files)
    , m_settings(settings) {
    const auto identityByte = static_cast<uint8_t>(255 >> std::clamp(settings.overbrightBits, 0, 2));
    const U8vec4 identity{identityByte, identityByte, identityByte, 255};
    const TextureFlags unmipped{false, false, true};
    addBuiltin("*default", makeDefaultImage(), {true, false, false});
    addBuiltin("*white", makeSolidImage(8, U8vec4(255)), {false, false, false});
    addBuiltin("*identityLight", makeSolidImage(8, identity), {false, false, false});
    addBuiltin("*dlight", makeDlightImage(), unmipped);
    addBuiltin("*fog", makeFogImage(), unmipped);
    for (int i = 0; i < builtinTexture::kScratchCount; ++i) {
        const TextureId id = addBuiltin("*scratch" + std::to_string(i), makeSolidImage(16, identity), unmipped);
        // Named without a number, the first one answers.
        if (i == 0) m_byName.emplace("*scratch", id);
    }
}

TextureId TextureLibrary::add(Texture texture) {
    texture.averageColor = averageColor(texture.levels.front());
    const auto id = static_cast<TextureId>(m_textures.size());
    m_byName[texture.name] = id;
    m_textures.push_back(std::make_unique<Texture>(std::move(texture)));
    return id;
}

TextureId TextureLibrary::addBuiltin(std::string name, MipLevel pixels, TextureFlags flags) {
    Texture texture;
    texture.name = std::move(name);
    texture.flags = flags;
    texture.hasAlpha = anyTransparent(pixels.rgba);
    texture.levels = buildTextureLevels(std::move(pixels), flags, m_settings);
    return add(std::move(texture));
}

std::optional<TextureId> TextureLibrary::load(std::string_view name, TextureFlags flags) {
    const std::string key(name);
    if (const auto known = m_byName.find(key); known != m_byName.end()) return known->second;
    if (m_missing.contains(key)) return std::nullopt;
    std::optional<Image> image;
    if (name.size() > kMaxImageName)
        logLineOnce(LogLevel::Warning, "%s: image name longer than %zu characters; rename the file", key.c_str(),
                    kMaxImageName);
    else if (!name.empty() && name.front() != '*')
        image = findImage(m_files, name);
    if (!image) {
        m_missing.insert(key);
        return std::nullopt;
    }
    Texture texture;
    texture.name = key;
    texture.flags = flags;
    texture.hasAlpha = anyTransparent(image->rgba);
    texture.levels = buildTextureLevels({image->width, image->height, std::move(image->rgba)}, flags, m_settings);
    return add(std::move(texture));
}

TextureId TextureLibrary::addLightmap(int page, const uint8_t* rgb) {
    constexpr size_t kSize = 128;
    Texture texture;
    texture.name = "*lightmap" + std::to_string(page);
    texture.flags = {false, false, true};
    MipLevel level{static_cast<int>(kSize), static_cast<int>(kSize), {}};
    level.rgba.resize(kSize * kSize * 4);
    const int shift = m_settings.mapOverbrightBits - m_settings.overbrightBits;
    for (size_t i = 0; i < kSize * kSize; ++i) {
        const uint8_t* raw = rgb + 3 * i;
        const U8vec4 color =
            m_settings.lightmapIntensity ? intensityColor(raw) : shiftBakedLight({raw[0], raw[1], raw[2], 255}, shift);
        for (int k = 0; k < 4; ++k)
            level.rgba[4 * i + static_cast<size_t>(k)] = color[k];
    }
    if (m_settings.greyscale > 0) convertToGrey(level, m_settings.greyscale);
    texture.levels.push_back(std::move(level));
    return add(std::move(texture));
}

void TextureLibrary::dropTexels(TextureId id) {
    if (id >= builtinTexture::kScratch0 && id < builtinTexture::kFirstFree) return;
    for (MipLevel& level : m_textures[id]->levels)
        level.rgba = {};
}

void TextureLibrary::setScratch(int slot, int width, int height, const uint8_t* rgba) {
    if (slot < 0 || slot >= builtinTexture::kScratchCount || width <= 0 || height <= 0)
        throw UsageError(formatText("cinematic slot %d of %dx%d pixels; slots are 0 to %d", slot, width, height,
                                    builtinTexture::kScratchCount - 1));
    Texture& texture = *m_textures[builtinTexture::kScratch0 + static_cast<TextureId>(slot)];
    MipLevel& level = texture.levels.front();
    level.width = width;
    level.height = height;
    level.rgba.assign(rgba, rgba + static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
    for (size_t i = 3; i < level.rgba.size(); i += 4)
        level.rgba[i] = 255;
    ++texture.version;
}

std::optional<vec3> TextureLibrary::averageColorOf(std::string_view name) {
    const std::string key(name);
    if (const auto known = m_averages.find(key); known != m_averages.end()) return known->second;
    std::optional<vec3> mean;
    if (!name.empty() && name.front() != '*')
        if (auto image = findImage(m_files, name))
            mean = vec3(averageColor({image->width, image->height, std::move(image->rgba)}));
    return m_averages[key] = mean;
}

U8vec4 shiftBakedLight(U8vec4 color, int shift) {
    // A display brighter than the map (negative shift) is undefined in the original; darkening is the sane reading.
    const auto shifted = [shift](uint8_t c) { return shift >= 0 ? c << shift : c >> -shift; };
    int r = shifted(color.r), g = shifted(color.g), b = shifted(color.b);
    const int largest = std::max({r, g, b});
    if (largest > 255) {
        r = r * 255 / largest;
        g = g * 255 / largest;
        b = b * 255 / largest;
    }
    return {static_cast<uint8_t>(r), static_cast<uint8_t>(g), static_cast<uint8_t>(b), color.a};
}

} // namespace q3rt
