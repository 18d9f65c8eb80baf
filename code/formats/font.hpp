#pragma once
// fontImage_<pt>.dat: 256 glyph records, a scale and a name; 20,548 bytes, the memory layout of the engine's fontInfo.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace q3rt {

struct FontGlyph {
    int height = 0, top = 0, bottom = 0, pitch = 0, xSkip = 0, imageWidth = 0, imageHeight = 0;
    float s = 0, t = 0, s2 = 0, t2 = 0;
    std::string shaderName;
};

struct Font {
    std::array<FontGlyph, 256> glyphs;
    float glyphScale = 1.0f;
};

Font parseFont(std::span<const std::byte> file, std::string_view name);

} // namespace q3rt
