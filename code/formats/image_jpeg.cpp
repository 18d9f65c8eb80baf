// JPEG by libjpeg with its defaults (accurate integer transform, smooth chroma), so that texels equal the engine's.

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <jpeglib.h>

#include "base/error.hpp"
#include "formats/image_formats.hpp"

namespace q3rt {
namespace {

/// The least a baseline picture spends is one bit on an 8x8 block: 512 pixels a byte. Twice that leaves room for files
/// that lack their end, which still show what they have.
constexpr int64_t kMaxPixelsPerByte = 1024;

/// A picture of many scans costs its whole size for each; real ones have about ten.
constexpr int kMaxScans = 100;

constexpr int kFullChromaQuality = 85; ///< from here on the engine's screenshots keep every chroma sample

struct JpegFailure {
    jpeg_error_mgr manager;
    std::jmp_buf jump;
    char text[JMSG_LENGTH_MAX];
};

void failJump(j_common_ptr jpeg) {
    auto* failure = reinterpret_cast<JpegFailure*>(jpeg->err);
    jpeg->err->format_message(jpeg, failure->text);
    std::longjmp(failure->jump, 1);
}

void ignoreMessage(j_common_ptr, int) {}

jpeg_error_mgr* prepareFailure(JpegFailure& failure) {
    jpeg_error_mgr* manager = jpeg_std_error(&failure.manager);
    manager->error_exit = failJump;
    manager->emit_message = ignoreMessage;
    return manager;
}

void limitScans(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= kMaxScans) return;
    auto* failure = reinterpret_cast<JpegFailure*>(jpeg->err);
    std::snprintf(failure->text, sizeof(failure->text), "has more than %d scans", kMaxScans);
    std::longjmp(failure->jump, 1);
}

// The library's errors jump out of the functions below, so these own nothing: what must be freed belongs to the caller.

bool readJpegHeader(jpeg_decompress_struct& jpeg, std::span<const std::byte> file, jpeg_progress_mgr& progress,
                    JpegFailure& failure) {
    if (setjmp(failure.jump)) return false;
    jpeg_create_decompress(&jpeg);
    jpeg.progress = &progress;
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()), file.size());
    jpeg_read_header(&jpeg, TRUE);
    jpeg.out_color_space = JCS_RGB;
    return true;
}

/// Fills `rgba` from its own rows: RGB goes to the start of each row's space and is spread from the end backwards.
bool readJpegRows(jpeg_decompress_struct& jpeg, uint8_t* rgba, JpegFailure& failure) {
    if (setjmp(failure.jump)) return false;
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
        uint8_t* row = rgba + static_cast<size_t>(jpeg.output_scanline) * jpeg.output_width * 4;
        JSAMPROW target = row;
        jpeg_read_scanlines(&jpeg, &target, 1);
        for (size_t x = jpeg.output_width; x-- > 0;) {
            std::memmove(row + x * 4, row + x * 3, 3);
            row[x * 4 + 3] = 255;
        }
    }
    jpeg_finish_decompress(&jpeg);
    return true;
}

/// Frees the library's object when the C++ side leaves, by return or by exception.
struct Decompressor {
    jpeg_decompress_struct jpeg{};
    ~Decompressor() { jpeg_destroy_decompress(&jpeg); }
};

struct Compressor {
    jpeg_compress_struct jpeg{};
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    ~Compressor() {
        jpeg_destroy_compress(&jpeg);
        std::free(bytes);
    }
};

bool writeJpegRows(Compressor& compressor, int width, int height, const uint8_t* rgb, int quality,
                   JpegFailure& failure) {
    if (setjmp(failure.jump)) return false;
    jpeg_compress_struct& jpeg = compressor.jpeg;
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &compressor.bytes, &compressor.size);
    jpeg.image_width = static_cast<JDIMENSION>(width);
    jpeg.image_height = static_cast<JDIMENSION>(height);
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, quality, TRUE);
    if (quality >= kFullChromaQuality) {
        jpeg.comp_info[0].h_samp_factor = 1;
        jpeg.comp_info[0].v_samp_factor = 1;
    }
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        // The library only reads the row, but its interface has no const.
        JSAMPROW row = const_cast<uint8_t*>(rgb + static_cast<size_t>(jpeg.next_scanline) * jpeg.image_width * 3);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
}

} // namespace

Image decodeJpeg(std::span<const std::byte> file, const std::string& name) {
    JpegFailure failure{};
    Decompressor decompressor;
    decompressor.jpeg.err = prepareFailure(failure);
    jpeg_progress_mgr progress{};
    progress.progress_monitor = limitScans;
    if (!readJpegHeader(decompressor.jpeg, file, progress, failure)) failImage(name, failure.text);
    const int64_t width = decompressor.jpeg.image_width, height = decompressor.jpeg.image_height;
    checkImageSize(width, height, file.size(), kMaxPixelsPerByte, name);
    Image image{static_cast<int>(width), static_cast<int>(height), {}};
    image.rgba.resize(static_cast<size_t>(width * height) * 4);
    if (!readJpegRows(decompressor.jpeg, image.rgba.data(), failure)) failImage(name, failure.text);
    return image;
}

std::vector<std::byte> encodeJpeg(int width, int height, std::span<const uint8_t> rgb, int quality) {
    if (width < 1 || height < 1 || rgb.size() != static_cast<size_t>(width) * static_cast<size_t>(height) * 3)
        throw UsageError("encodeJpeg: the pixels don't fit the size");
    JpegFailure failure{};
    Compressor compressor;
    compressor.jpeg.err = prepareFailure(failure);
    if (!writeJpegRows(compressor, width, height, rgb.data(), quality, failure))
        throw ContentError(formatText("a JPEG of %dx%d pixels can't be made: %s", width, height, failure.text));
    const auto* first = reinterpret_cast<const std::byte*>(compressor.bytes);
    return {first, first + compressor.size};
}

} // namespace q3rt
