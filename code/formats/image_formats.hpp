#pragma once
// One decoder a file type, behind decodeImage. Each throws ContentError; `name` goes into the message.

#include <string>

#include "formats/image.hpp"

namespace q3rt {

Image decodeTga(std::span<const std::byte> file, const std::string& name);
Image decodeJpeg(std::span<const std::byte> file, const std::string& name);
Image decodePng(std::span<const std::byte> file, const std::string& name);
Image decodePcx(std::span<const std::byte> file, const std::string& name);
Image decodeBmp(std::span<const std::byte> file, const std::string& name);

/// Throws unless the picture has pixels and its RGBA form stays below 2 GiB (the engine's limit: it counts in int) and
/// `fileBytes` can hold it, given that a byte of this format never stands for more than `maxPixelsPerByte` pixels.
/// Called before memory is taken: a header of a few bytes must not claim gigabytes.
void checkImageSize(int64_t width, int64_t height, size_t fileBytes, int64_t maxPixelsPerByte, const std::string& name);

[[noreturn]] void failImage(const std::string& name, const std::string& what);

} // namespace q3rt
