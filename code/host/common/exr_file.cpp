#include "host/common/exr_file.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include "base/error.hpp"

namespace q3rt {
namespace {

constexpr const char* kChannels[3] = {"R", "G", "B"};
constexpr int kMostPixelsASide = 16384; ///< as of every picture that q3rt draws
/// Deflate shrinks to 1/1032 at best and a pixel has 2 bytes or more: a file that promises more is damaged.
constexpr int64_t kMostPixelsPerByte = 516;

/// A file that grows in memory.
class MemoryOutput : public Imf::OStream {
  public:
    explicit MemoryOutput(std::vector<std::byte>& bytes)
        : OStream("memory")
        , m_bytes(bytes) {}
    void write(const char data[], int count) override {
        const auto length = static_cast<size_t>(count);
        if (m_position + length > m_bytes.size()) m_bytes.resize(m_position + length);
        std::memcpy(m_bytes.data() + m_position, data, length);
        m_position += length;
    }
    uint64_t tellp() override { return m_position; }
    void seekp(uint64_t position) override { m_position = position; }

  private:
    std::vector<std::byte>& m_bytes;
    size_t m_position = 0;
};

class MemoryInput : public Imf::IStream {
  public:
    MemoryInput(std::span<const std::byte> bytes, const std::string& name)
        : IStream(name.c_str())
        , m_bytes(bytes) {}
    bool read(char data[], int count) override {
        const auto length = static_cast<size_t>(count);
        if (count < 0 || m_position > m_bytes.size() || length > m_bytes.size() - m_position)
            throw ContentError("the file is cut off");
        std::memcpy(data, m_bytes.data() + m_position, length);
        m_position += length;
        return m_position < m_bytes.size();
    }
    uint64_t tellg() override { return m_position; }
    void seekg(uint64_t position) override { m_position = position; }

  private:
    std::span<const std::byte> m_bytes;
    size_t m_position = 0;
};

/// Channel `c` of RGB pixels whose first one stands at `corner` of the file's coordinates.
Imf::Slice sliceOf(FloatImage& image, size_t c, Imath::V2i corner) {
    constexpr size_t kPixelBytes = 3 * sizeof(float);
    return Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + c, corner, image.width, image.height, kPixelBytes,
                            kPixelBytes * static_cast<size_t>(image.width));
}

FloatImage readImage(Imf::InputFile& file, size_t fileBytes) {
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > kMostPixelsASide || height > kMostPixelsASide ||
        width * height > kMostPixelsPerByte * static_cast<int64_t>(fileBytes))
        throw ContentError(formatText("%lld x %lld pixels in %zu bytes", static_cast<long long>(width),
                                      static_cast<long long>(height), fileBytes));
    const Imf::ChannelList& channels = file.header().channels();
    const bool grey = !channels.findChannel("R") && channels.findChannel("Y");
    FloatImage image;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.rgb.resize(static_cast<size_t>(width * height) * 3);
    Imf::FrameBuffer pixels;
    for (size_t c = 0; c < (grey ? 1 : 3); ++c) {
        const char* name = grey ? "Y" : kChannels[c];
        const Imf::Channel* channel = channels.findChannel(name);
        if (!channel) throw ContentError(formatText("there is no channel %s", name));
        if (channel->xSampling != 1 || channel->ySampling != 1)
            throw ContentError(formatText("channel %s has fewer samples than pixels", name));
        pixels.insert(name, sliceOf(image, c, window.min));
    }
    file.setFrameBuffer(pixels);
    file.readPixels(window.min.y, window.max.y);
    for (size_t i = 0; grey && i < image.rgb.size(); i += 3)
        image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
    return image;
}

} // namespace

std::vector<std::byte> encodeExr(const FloatImage& image, const std::string& unit) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addComments(header, unit);
    FloatImage copy = image; // the library asks for a writable place
    Imf::FrameBuffer pixels;
    for (size_t c = 0; c < 3; ++c) {
        header.channels().insert(kChannels[c], Imf::Channel(Imf::FLOAT));
        pixels.insert(kChannels[c], sliceOf(copy, c, {0, 0}));
    }
    std::vector<std::byte> bytes;
    MemoryOutput stream(bytes);
    {
        Imf::OutputFile file(stream, header, 0); // 0: no threads
        file.setFrameBuffer(pixels);
        file.writePixels(image.height);
    } // completes the file
    return bytes;
}

FloatImage decodeExr(std::span<const std::byte> bytes, const std::string& name) {
    try {
        MemoryInput stream(bytes, name);
        Imf::InputFile file(stream, 0);
        return readImage(file, bytes.size());
    } catch (const std::exception& error) { // the library's own errors, and ours without a name
        std::string reason = error.what();
        std::replace(reason.begin(), reason.end(), '\n', ' ');
        throw ContentError(formatText("%s: is no OpenEXR picture that can be read (%s); replace the image",
                                      name.c_str(), reason.c_str()));
    }
}

} // namespace q3rt
