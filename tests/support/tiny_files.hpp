#pragma once
// The smallest files of the binary formats, made in memory: something valid to damage, with or without game data.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

namespace q3rt::test {

/// Appends numbers and fixed-size texts in file order.
class ByteWriter {
  public:
    template <typename T>
    ByteWriter& put(T value) {
        addBytes(&value, sizeof(T));
        return *this;
    }
    ByteWriter& ints(std::initializer_list<int32_t> values) {
        for (const int32_t value : values)
            put(value);
        return *this;
    }
    ByteWriter& floats(std::initializer_list<float> values) {
        for (const float value : values)
            put(value);
        return *this;
    }
    ByteWriter& text(const std::string& value, size_t size) {
        std::string padded = value;
        padded.resize(size, '\0');
        for (const char c : padded)
            m_bytes.push_back(static_cast<std::byte>(c));
        return *this;
    }
    ByteWriter& append(const std::vector<std::byte>& bytes) {
        m_bytes.insert(m_bytes.end(), bytes.begin(), bytes.end());
        return *this;
    }
    const std::vector<std::byte>& bytes() const { return m_bytes; }

  private:
    void addBytes(const void* bytes, size_t count);
    std::vector<std::byte> m_bytes;
};

/// A map of one square (planar), one 3x3 patch, one brush, one node and two leafs. Change `lumps`, then build().
struct TinyBsp {
    std::array<std::vector<std::byte>, 17> lumps;
    int version = 46;

    TinyBsp();
    std::vector<std::byte> build() const;
    /// Overwrites the 32-bit number at `offset` of a lump.
    template <typename T>
    void set(size_t lump, size_t offset, T value) {
        std::memcpy(lumps.at(lump).data() + offset, &value, sizeof(T));
    }
};

/// A model of one triangle, one tag and two frames; the names of its surface and shader are as given.
std::vector<std::byte> makeTinyMd3(const std::string& surfaceName = "H_Part_1", const std::string& shader = "a.tga");

/// Overwrites the bytes at `offset` of a file.
template <typename T>
void overwrite(std::vector<std::byte>& file, size_t offset, T value) {
    std::memcpy(file.data() + offset, &value, sizeof(T));
}

/// An uncompressed, a run-length coded or a grey TGA header with `payload` behind it.
std::vector<std::byte> makeTga(int type, int width, int height, int bitsPerPixel, const std::vector<uint8_t>& payload,
                               int descriptor = 0);

/// A palette picture whose entry i is (i, 255 - i, 7).
std::vector<std::byte> makePcx(int width, int height, const std::vector<uint8_t>& payload);

/// An uncompressed BMP; `payload` starts with the palette for 8 bits.
std::vector<std::byte> makeBmp(int width, int height, int bitsPerPixel, const std::vector<uint8_t>& payload);

/// A font file whose glyph i has height i and shader name "g<i>".
std::vector<std::byte> makeFont();

} // namespace q3rt::test
