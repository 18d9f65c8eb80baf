// BMP: 8, 24 and 32 bits, uncompressed, rows always taken bottom-up; 32 bits keep their alpha.

#include <cstdlib>

#include "formats/byte_reader.hpp"
#include "formats/image_formats.hpp"

namespace q3rt {
namespace {

constexpr size_t kFileHeaderBytes = 14;
constexpr size_t kPaletteEntryBytes = 4;
constexpr uint32_t kMinInfoHeaderBytes = 40;

struct BmpHeader {
    int64_t width = 0, height = 0;
    int bitsPerPixel = 0;
    uint32_t pixelsOffset = 0;
    uint32_t paletteOffset = 0;
};

BmpHeader readHeader(ByteReader& reader, const std::string& name) {
    BmpHeader header;
    if (reader.u8() != 'B' || reader.u8() != 'M') failImage(name, "is no BMP");
    reader.skip(8); // file size, reserved
    header.pixelsOffset = reader.read<uint32_t>();
    const auto infoBytes = reader.read<uint32_t>();
    if (infoBytes < kMinInfoHeaderBytes || infoBytes > reader.remaining())
        failImage(name, "has a header that can't be used");
    header.paletteOffset = static_cast<uint32_t>(kFileHeaderBytes) + infoBytes;
    header.width = reader.i32();
    header.height = std::abs(int64_t{reader.i32()});
    reader.skip(2); // planes
    header.bitsPerPixel = reader.read<uint16_t>();
    const auto compression = reader.read<uint32_t>();
    if (compression != 0) failImage(name, "is a compressed BMP; only uncompressed ones can be used");
    if (header.bitsPerPixel != 8 && header.bitsPerPixel != 24 && header.bitsPerPixel != 32)
        failImage(name, formatText("is a BMP of %d bits a pixel; 8, 24 and 32 can be used", header.bitsPerPixel));
    return header;
}

} // namespace

Image decodeBmp(std::span<const std::byte> file, const std::string& name) {
    ByteReader headerReader(file, name);
    const BmpHeader header = readHeader(headerReader, name);
    checkImageSize(header.width, header.height, file.size(), 1, name);
    const auto bytesPerPixel = static_cast<size_t>(header.bitsPerPixel / 8);
    const auto width = static_cast<size_t>(header.width), height = static_cast<size_t>(header.height);
    const size_t rowBytes = (width * bytesPerPixel + 3) / 4 * 4;
    // The padding of the last row may be missing.
    const size_t neededBytes = rowBytes * (height - 1) + width * bytesPerPixel;
    if (header.pixelsOffset > file.size() || neededBytes > file.size() - header.pixelsOffset)
        failImage(name, "ends before its last pixel");
    const auto pixels = file.subspan(header.pixelsOffset);
    const auto palette = file.subspan(header.paletteOffset);

    Image image{static_cast<int>(width), static_cast<int>(height), {}};
    image.rgba.resize(width * height * 4);
    for (size_t y = 0; y < height; ++y) {
        for (size_t x = 0; x < width; ++x) {
            auto source = pixels.subspan((height - 1 - y) * rowBytes + x * bytesPerPixel, bytesPerPixel);
            if (bytesPerPixel == 1) {
                const size_t entry = static_cast<size_t>(source[0]) * kPaletteEntryBytes;
                if (entry + kPaletteEntryBytes > palette.size()) failImage(name, "its palette is too short");
                source = palette.subspan(entry, kPaletteEntryBytes);
            }
            uint8_t* pixel = &image.rgba[(y * width + x) * 4];
            for (size_t channel = 0; channel < 3; ++channel)
                pixel[channel] = static_cast<uint8_t>(source[2 - channel]);
            pixel[3] = header.bitsPerPixel == 32 ? static_cast<uint8_t>(source[3]) : 255;
        }
    }
    return image;
}

} // namespace q3rt
