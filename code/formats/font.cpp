#include "formats/font.hpp"

#include <cmath>

#include "formats/byte_reader.hpp"

namespace q3rt {
namespace {

constexpr size_t kGlyphNameBytes = 32;
constexpr size_t kFontNameBytes = 64;
constexpr size_t kFontFileBytes = 256 * (7 * 4 + 4 * 4 + 4 + kGlyphNameBytes) + 4 + kFontNameBytes;
static_assert(kFontFileBytes == 20548);

float readFinite(ByteReader& reader) {
    const float value = reader.f32();
    return std::isfinite(value) ? value : 0.0f;
}

} // namespace

Font parseFont(std::span<const std::byte> file, std::string_view name) {
    if (file.size() != kFontFileBytes)
        throw ContentError(formatText("%.*s: a font file has %zu bytes, this one %zu; replace it",
                                      static_cast<int>(name.size()), name.data(), kFontFileBytes, file.size()));
    ByteReader reader(file, name);
    Font font;
    for (FontGlyph& glyph : font.glyphs) {
        glyph.height = reader.i32();
        glyph.top = reader.i32();
        glyph.bottom = reader.i32();
        glyph.pitch = reader.i32();
        glyph.xSkip = reader.i32();
        glyph.imageWidth = reader.i32();
        glyph.imageHeight = reader.i32();
        glyph.s = readFinite(reader);
        glyph.t = readFinite(reader);
        glyph.s2 = readFinite(reader);
        glyph.t2 = readFinite(reader);
        reader.skip(4); // the shader handle of the program that wrote the file
        glyph.shaderName = reader.text(kGlyphNameBytes);
    }
    font.glyphScale = readFinite(reader);
    return font;
}

} // namespace q3rt
