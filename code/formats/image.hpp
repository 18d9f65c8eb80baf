#pragma once
// TGA, JPEG, PNG, PCX, BMP -> 8-bit RGBA, top row first. Behaves as the engine's loaders do (TGA is always read
// bottom-up; JPEG has alpha 255). Throws ContentError naming the file.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace q3rt {

struct Image {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba; ///< width * height * 4, top row first
};

/// Decodes by the extension of `name` (tga, jpg, jpeg, png, pcx, bmp).
Image decodeImage(std::span<const std::byte> file, std::string_view name);

/// Writers: PNG (8-bit RGB or RGBA), TGA 24-bit and JPEG as the engine's screenshots, PFM (RGB float, bottom row first
/// in the file). Pixels are given top row first to all of them.
std::vector<std::byte> encodePng(int width, int height, int channels, std::span<const uint8_t> pixels);
std::vector<std::byte> encodeTga24(int width, int height, std::span<const uint8_t> rgb);
std::vector<std::byte> encodeJpeg(int width, int height, std::span<const uint8_t> rgb, int quality);
std::vector<std::byte> encodePfm(int width, int height, std::span<const float> rgb);

/// Reads 32-bit float RGB, top row first, from PFM ("PF").
struct FloatImage {
    int width = 0, height = 0;
    std::vector<float> rgb;
};
FloatImage decodePfm(std::span<const std::byte> file, std::string_view name);

} // namespace q3rt
