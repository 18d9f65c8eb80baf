#pragma once
// Bounds-checked little-endian reading, shared by the binary formats.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/error.hpp"

namespace q3rt {

static_assert(std::endian::native == std::endian::little, "files are little-endian and are copied field by field");

/// Reads fields one after another. Whoever makes one has checked that the bytes are there, or lets `take` throw.
class ByteReader {
  public:
    /// `what` names file and part in messages and must outlive the reader.
    ByteReader(std::span<const std::byte> bytes, std::string_view what)
        : m_bytes(bytes)
        , m_what(what) {}

    std::span<const std::byte> take(size_t length) {
        if (length > m_bytes.size())
            throw ContentError(std::string(m_what) + ": ends too early; the file is damaged, get it again");
        const auto taken = m_bytes.first(length);
        m_bytes = m_bytes.subspan(length);
        return taken;
    }
    void skip(size_t length) { take(length); }
    size_t remaining() const { return m_bytes.size(); }
    std::span<const std::byte> rest() const { return m_bytes; }

    template <typename T>
    T read() {
        static_assert(std::is_arithmetic_v<T>);
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }
    uint8_t u8() { return read<uint8_t>(); }
    int32_t i32() { return read<int32_t>(); }
    float f32() { return read<float>(); }

    /// A fixed-size field that holds a text up to the first zero byte.
    std::string text(size_t length) {
        const auto field = take(length);
        const char* characters = reinterpret_cast<const char*>(field.data());
        return std::string(characters, strnlen(characters, length));
    }

  private:
    std::span<const std::byte> m_bytes;
    std::string_view m_what;
};

} // namespace q3rt
