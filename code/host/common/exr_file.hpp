#pragma once
// OpenEXR pictures: 32-bit float RGB. Only the program links the library.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/image.hpp"

namespace q3rt {

/// `unit` says what 1.0 means; it goes into the file's header.
std::vector<std::byte> encodeExr(const FloatImage& image, const std::string& unit);

/// Channels R, G, B of the data window, half or float; a file with Y only is grey. Throws ContentError naming the file.
FloatImage decodeExr(std::span<const std::byte> file, const std::string& name);

} // namespace q3rt
