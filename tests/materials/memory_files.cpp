#include "memory_files.hpp"

namespace q3rt::test {

std::vector<std::byte> makeTga(int width, int height, const std::function<U8vec4(int, int)>& pixel) {
    std::vector<std::byte> bytes(18);
    bytes[2] = std::byte{2}; // uncompressed true colour
    bytes[12] = std::byte(width & 255);
    bytes[13] = std::byte(width >> 8);
    bytes[14] = std::byte(height & 255);
    bytes[15] = std::byte(height >> 8);
    bytes[16] = std::byte{32};
    bytes[17] = std::byte{8};
    for (int y = height - 1; y >= 0; --y)
        for (int x = 0; x < width; ++x) {
            const U8vec4 c = pixel(x, y);
            for (const uint8_t channel : {c.b, c.g, c.r, c.a})
                bytes.push_back(std::byte{channel});
        }
    return bytes;
}

void MemoryFiles::addText(std::string name, std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    add(std::move(name), {first, first + text.size()});
}

void MemoryFiles::addTga(std::string name, int width, int height, const std::function<U8vec4(int, int)>& pixel) {
    add(std::move(name), makeTga(width, height, pixel));
}

std::optional<std::vector<std::byte>> MemoryFiles::read(std::string_view name) {
    for (const auto& [known, bytes] : m_files)
        if (known == name) return bytes;
    return std::nullopt;
}

std::vector<std::string> MemoryFiles::list(std::string_view directory, std::string_view extension) {
    std::vector<std::string> names;
    const std::string prefix = std::string(directory) + "/";
    for (const auto& entry : m_files)
        if (entry.first.starts_with(prefix) && entry.first.ends_with(extension))
            names.push_back(entry.first.substr(prefix.size()));
    return names;
}

} // namespace q3rt::test
