// PCX: 8 bits a pixel with a palette at the end of the file, run-length encoded, as the engine reads them.

#include "formats/byte_reader.hpp"
#include "formats/image_formats.hpp"

namespace q3rt {
namespace {

constexpr size_t kHeaderBytes = 128;
constexpr size_t kPaletteBytes = 768;
constexpr int kPaletteMark = 12;
constexpr int kMaxSide = 1023; ///< of the engine's loader
constexpr int kMaxRun = 63;

struct PcxHeader {
    int width = 0, height = 0, rowBytes = 0;
};

PcxHeader readHeader(ByteReader& reader, const std::string& name) {
    const int manufacturer = reader.u8();
    const int version = reader.u8();
    const int encoding = reader.u8();
    const int bitsPerPixel = reader.u8();
    if (manufacturer != 10 || version != 5 || encoding != 1)
        failImage(name, "is no run-length encoded PCX of version 5");
    const int xMin = reader.read<uint16_t>(), yMin = reader.read<uint16_t>();
    const int xMax = reader.read<uint16_t>(), yMax = reader.read<uint16_t>();
    reader.skip(2 + 2 + 48 + 1); // resolution, 16-colour palette, reserved
    const int planes = reader.u8();
    PcxHeader header{xMax - xMin + 1, yMax - yMin + 1, reader.read<uint16_t>()};
    if (bitsPerPixel != 8 || planes != 1)
        failImage(name, formatText("is a PCX of %d planes of %d bits; only one of 8 bits with a palette can be used",
                                   planes, bitsPerPixel));
    if (header.width > kMaxSide || header.height > kMaxSide)
        failImage(name, formatText("is a PCX of %dx%d pixels; no side may be longer than %d", header.width,
                                   header.height, kMaxSide));
    if (header.rowBytes < header.width) failImage(name, "its rows are shorter than its width");
    return header;
}

} // namespace

Image decodePcx(std::span<const std::byte> file, const std::string& name) {
    if (file.size() < kHeaderBytes + 1 + kPaletteBytes) failImage(name, "is too short for a PCX");
    ByteReader headerReader(file.first(kHeaderBytes), name);
    const PcxHeader header = readHeader(headerReader, name);
    const auto palette = file.last(kPaletteBytes);
    if (static_cast<int>(file[file.size() - kPaletteBytes - 1]) != kPaletteMark) failImage(name, "has no palette");
    ByteReader reader(file.subspan(kHeaderBytes, file.size() - kHeaderBytes - 1 - kPaletteBytes), name);
    checkImageSize(header.width, header.height, reader.remaining(), kMaxRun, name);

    Image image{header.width, header.height, {}};
    image.rgba.resize(static_cast<size_t>(header.width) * static_cast<size_t>(header.height) * 4);
    uint8_t* pixel = image.rgba.data();
    int run = 0;
    size_t color = 0;
    for (int y = 0; y < header.height; ++y) {
        for (int x = 0; x < header.rowBytes; ++x) {
            while (run == 0) {
                const uint8_t code = reader.u8();
                const bool repeated = (code & 0xC0) == 0xC0;
                run = repeated ? code & 0x3F : 1;
                color = repeated ? reader.u8() : code;
            }
            --run;
            if (x >= header.width) continue;
            for (size_t channel = 0; channel < 3; ++channel)
                *pixel++ = static_cast<uint8_t>(palette[color * 3 + channel]);
            *pixel++ = 255;
        }
    }
    return image;
}

} // namespace q3rt
