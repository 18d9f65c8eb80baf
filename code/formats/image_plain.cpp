// The two formats that are written without a library: screenshots in TGA, radiance in PFM.

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/error.hpp"
#include "formats/image_formats.hpp"

namespace q3rt {
namespace {

void appendText(std::vector<std::byte>& file, const std::string& text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    file.insert(file.end(), first, first + text.size());
}

void checkPixelCount(int width, int height, size_t count, const char* what) {
    if (width < 1 || height < 1 || count != static_cast<size_t>(width) * static_cast<size_t>(height) * 3)
        throw UsageError(std::string(what) + ": the pixels don't fit the size");
}

/// The next word of a PFM header; exactly one white-space character follows it.
std::string_view cutHeaderWord(std::string_view& text) {
    const size_t start = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    const size_t end = std::min(text.find_first_of(" \t\r\n", start), text.size());
    const std::string_view word = text.substr(start, end - start);
    text.remove_prefix(std::min(end + 1, text.size()));
    return word;
}

template <typename Number>
Number parseNumber(std::string_view word, const std::string& name) {
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) failImage(name, "has a damaged PFM header");
    return number;
}

} // namespace

std::vector<std::byte> encodeTga24(int width, int height, std::span<const uint8_t> rgb) {
    checkPixelCount(width, height, rgb.size(), "encodeTga24");
    if (width > 0xFFFF || height > 0xFFFF)
        throw UsageError(formatText("a TGA can't hold %dx%d pixels; choose another format", width, height));
    std::vector<std::byte> file(18);
    file[2] = std::byte{2}; // uncompressed true colour
    file[12] = static_cast<std::byte>(width & 255);
    file[13] = static_cast<std::byte>(width >> 8);
    file[14] = static_cast<std::byte>(height & 255);
    file[15] = static_cast<std::byte>(height >> 8);
    file[16] = std::byte{24};
    file.reserve(file.size() + rgb.size());
    for (int y = height - 1; y >= 0; --y) {
        const uint8_t* row = &rgb[static_cast<size_t>(y) * static_cast<size_t>(width) * 3];
        for (int x = 0; x < width; ++x) {
            for (int channel = 2; channel >= 0; --channel)
                file.push_back(static_cast<std::byte>(row[x * 3 + channel]));
        }
    }
    return file;
}

std::vector<std::byte> encodePfm(int width, int height, std::span<const float> rgb) {
    checkPixelCount(width, height, rgb.size(), "encodePfm");
    std::vector<std::byte> file;
    // A negative scale means little-endian numbers.
    appendText(file, "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n");
    const size_t rowFloats = static_cast<size_t>(width) * 3;
    file.reserve(file.size() + rgb.size_bytes());
    for (size_t y = static_cast<size_t>(height); y-- > 0;) {
        const auto row = std::as_bytes(rgb.subspan(y * rowFloats, rowFloats));
        file.insert(file.end(), row.begin(), row.end());
    }
    return file;
}

FloatImage decodePfm(std::span<const std::byte> file, std::string_view name) {
    const std::string fullName(name);
    std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    if (cutHeaderWord(text) != "PF") failImage(fullName, "is no PFM picture of three channels");
    const int width = parseNumber<int>(cutHeaderWord(text), fullName);
    const int height = parseNumber<int>(cutHeaderWord(text), fullName);
    const float scale = parseNumber<float>(cutHeaderWord(text), fullName);
    if (!std::isfinite(scale) || scale == 0.0f) failImage(fullName, "has a damaged PFM header");
    checkImageSize(width, height, text.size(), 1, fullName);
    FloatImage image{width, height, {}};
    const size_t rowFloats = static_cast<size_t>(width) * 3;
    const size_t floatCount = rowFloats * static_cast<size_t>(height);
    if (text.size() < floatCount * sizeof(float)) failImage(fullName, "ends before its last pixel");
    image.rgb.resize(floatCount);
    for (size_t y = 0; y < static_cast<size_t>(height); ++y) {
        const size_t fileRow = static_cast<size_t>(height) - 1 - y;
        std::memcpy(&image.rgb[y * rowFloats], text.data() + fileRow * rowFloats * sizeof(float),
                    rowFloats * sizeof(float));
    }
    if (scale > 0.0f) {
        for (float& value : image.rgb)
            value = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<uint32_t>(value)));
    }
    return image;
}

} // namespace q3rt
