// PNG by stb_image and stb_image_write (zlib underneath for writing: smaller and faster than the library's own).

#include <zlib.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "base/error.hpp"
#include "formats/image_formats.hpp"

namespace {

/// What stb_image_write calls to pack the rows; the result is freed with free().
unsigned char* packWithZlib(unsigned char* data, int length, int* packedLength, int level) {
    uLongf size = compressBound(static_cast<uLong>(length));
    auto* packed = static_cast<unsigned char*>(std::malloc(size));
    if (!packed) return nullptr;
    if (compress2(packed, &size, data, static_cast<uLong>(length), level) != Z_OK) {
        std::free(packed);
        return nullptr;
    }
    *packedLength = static_cast<int>(size);
    return packed;
}

} // namespace

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wunused-parameter"
// An empty first data chunk makes stb_image copy 0 bytes to a null pointer: harmless, but the sanitizer stops there.
#ifdef __clang__
#pragma clang attribute push(__attribute__((no_sanitize("nonnull-attribute"))), apply_to = function)
#endif
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STBIW_ZLIB_COMPRESS packWithZlib
#include <stb_image_write.h>
#ifdef __clang__
#pragma clang attribute pop
#endif
#pragma GCC diagnostic pop

namespace q3rt {
namespace {

/// Deflate's best case is 1032 bytes from one, and a byte of a 1-bit picture is 8 pixels.
constexpr int64_t kMaxPixelsPerByte = 1032 * 8;

struct FreePixels {
    void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

/// A chunk may claim 2 GiB, and stb_image takes the memory before it looks for the bytes: each must lie in the file.
void checkChunks(std::span<const std::byte> file, const std::string& name) {
    constexpr size_t kSignatureBytes = 8, kLengthBytes = 4, kTypeBytes = 4, kSumBytes = 4;
    size_t at = kSignatureBytes;
    while (at + kLengthBytes + kTypeBytes <= file.size()) {
        uint32_t length = 0;
        for (size_t i = 0; i < kLengthBytes; ++i)
            length = length << 8 | std::to_integer<uint32_t>(file[at + i]);
        at += kLengthBytes + kTypeBytes;
        if (length > file.size() - at) failImage(name, "ends in the middle of a chunk");
        at += size_t{length} + kSumBytes;
    }
}

void appendBytes(void* target, void* data, int size) {
    const auto* first = static_cast<const std::byte*>(data);
    auto* bytes = static_cast<std::vector<std::byte>*>(target);
    bytes->insert(bytes->end(), first, first + size);
}

/// stb_image gives none for a kind of packed block that there isn't.
const char* failureReason() {
    const char* reason = stbi_failure_reason();
    return reason ? reason : "its packed pixels are damaged";
}

} // namespace

Image decodePng(std::span<const std::byte> file, const std::string& name) {
    if (file.size() > 0x7FFFFFFF) failImage(name, "is larger than 2 GiB");
    checkChunks(file, name);
    const auto* bytes = reinterpret_cast<const stbi_uc*>(file.data());
    const int length = static_cast<int>(file.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(bytes, length, &width, &height, &channels)) failImage(name, failureReason());
    checkImageSize(width, height, file.size(), kMaxPixelsPerByte, name);
    const std::unique_ptr<stbi_uc, FreePixels> pixels(
        stbi_load_from_memory(bytes, length, &width, &height, &channels, STBI_rgb_alpha));
    if (!pixels) failImage(name, failureReason());
    Image image{width, height, {}};
    image.rgba.assign(pixels.get(), pixels.get() + static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
    return image;
}

std::vector<std::byte> encodePng(int width, int height, int channels, std::span<const uint8_t> pixels) {
    if (width < 1 || height < 1 || (channels != 3 && channels != 4) ||
        pixels.size() != static_cast<size_t>(width) * static_cast<size_t>(height) * static_cast<size_t>(channels))
        throw UsageError("encodePng: the pixels don't fit the size");
    std::vector<std::byte> file;
    if (!stbi_write_png_to_func(appendBytes, &file, width, height, channels, pixels.data(), width * channels))
        throw ContentError(formatText("a PNG of %dx%d pixels can't be made: out of memory", width, height));
    return file;
}

} // namespace q3rt
