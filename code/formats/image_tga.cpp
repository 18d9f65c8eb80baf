// Truevision TGA: types 2, 3 and 10. Rows are always taken bottom-up, whatever the descriptor says, because content was
// authored against that.

#include "base/log.hpp"
#include "formats/byte_reader.hpp"
#include "formats/image_formats.hpp"

namespace q3rt {
namespace {

constexpr int kTypeTrueColor = 2, kTypeGrey = 3, kTypeRunLengthTrueColor = 10;
constexpr int kDescriptorTopDown = 0x20;
constexpr int kMaxRun = 128; ///< pixels of one packet

struct TgaHeader {
    int type = 0, width = 0, height = 0, bitsPerPixel = 0, descriptor = 0;
};

TgaHeader readHeader(ByteReader& reader, const std::string& name) {
    TgaHeader header;
    const int idLength = reader.u8();
    const int colorMapType = reader.u8();
    header.type = reader.u8();
    reader.skip(5 + 4); // colour map specification, origin
    header.width = reader.read<uint16_t>();
    header.height = reader.read<uint16_t>();
    header.bitsPerPixel = reader.u8();
    header.descriptor = reader.u8();
    if (header.type != kTypeTrueColor && header.type != kTypeGrey && header.type != kTypeRunLengthTrueColor)
        failImage(name, formatText("is a TGA of type %d; types 2, 3 and 10 can be used", header.type));
    if (colorMapType != 0) failImage(name, "is a TGA with a colour map, which can't be used");
    const bool grey = header.type == kTypeGrey && header.bitsPerPixel == 8;
    if (!grey && header.bitsPerPixel != 24 && header.bitsPerPixel != 32)
        failImage(name, formatText("is a TGA of %d bits a pixel; 24 and 32 can be used", header.bitsPerPixel));
    reader.skip(static_cast<size_t>(idLength));
    return header;
}

/// Writes one pixel after another, from the bottom row upwards.
class BottomUpWriter {
  public:
    explicit BottomUpWriter(Image& image)
        : m_image(image)
        , m_row(image.height - 1) {}

    bool full() const { return m_row < 0; }
    void write(const uint8_t (&rgba)[4]) {
        const size_t pixel =
            static_cast<size_t>(m_row) * static_cast<size_t>(m_image.width) + static_cast<size_t>(m_column);
        std::memcpy(&m_image.rgba[pixel * 4], rgba, 4);
        if (++m_column < m_image.width) return;
        m_column = 0;
        --m_row;
    }

  private:
    Image& m_image;
    int m_row;
    int m_column = 0;
};

void readPixel(ByteReader& reader, int bytesPerPixel, uint8_t (&rgba)[4]) {
    const auto bytes = reader.take(static_cast<size_t>(bytesPerPixel));
    const auto channel = [&](int i) {
        return static_cast<uint8_t>(bytes[static_cast<size_t>(bytesPerPixel == 1 ? 0 : i)]);
    };
    rgba[0] = channel(2);
    rgba[1] = channel(1);
    rgba[2] = channel(0);
    rgba[3] = bytesPerPixel == 4 ? channel(3) : 255;
}

/// Packets may run over the end of a row; one that runs over the end of the picture is cut.
void readPackets(ByteReader& reader, int bytesPerPixel, BottomUpWriter& writer) {
    uint8_t rgba[4];
    while (!writer.full()) {
        const int packet = reader.u8();
        const bool run = packet & 128;
        const int count = (packet & 127) + 1;
        for (int i = 0; i < count && !writer.full(); ++i) {
            if (i == 0 || !run) readPixel(reader, bytesPerPixel, rgba);
            writer.write(rgba);
        }
    }
}

} // namespace

Image decodeTga(std::span<const std::byte> file, const std::string& name) {
    ByteReader reader(file, name);
    const TgaHeader header = readHeader(reader, name);
    const int bytesPerPixel = header.bitsPerPixel / 8;
    const bool packed = header.type == kTypeRunLengthTrueColor;
    checkImageSize(header.width, header.height, reader.remaining(), packed ? kMaxRun / (1 + bytesPerPixel) : 1, name);
    if (header.descriptor & kDescriptorTopDown)
        logLineOnce(LogLevel::Developer, "%s: is stored top row first but used bottom row first", name.c_str());
    Image image{header.width, header.height, {}};
    image.rgba.resize(static_cast<size_t>(header.width) * static_cast<size_t>(header.height) * 4);
    BottomUpWriter writer(image);
    if (packed) {
        readPackets(reader, bytesPerPixel, writer);
        return image;
    }
    uint8_t rgba[4];
    while (!writer.full()) {
        readPixel(reader, bytesPerPixel, rgba);
        writer.write(rgba);
    }
    return image;
}

} // namespace q3rt
