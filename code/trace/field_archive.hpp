#pragma once
// Fields of a struct to bytes and back: plain values as they lie in memory (little endian), texts and lists behind a
// 32-bit count.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.hpp"

namespace q3rt {

/// Appends fields to a byte vector.
class Encoder {
  public:
    explicit Encoder(std::vector<std::byte>& out)
        : m_out(out) {}

    template <class Value>
    void operator()(Value& value) {
        static_assert(std::is_trivially_copyable_v<Value>);
        append(&value, sizeof value);
    }
    void operator()(std::string& text) { appendList(text.data(), text.size(), 1); }
    template <class Item>
    void operator()(std::vector<Item>& list) {
        static_assert(std::is_trivially_copyable_v<Item>);
        appendList(list.data(), list.size(), sizeof(Item));
    }

  private:
    void append(const void* data, size_t bytes) {
        const auto* first = static_cast<const std::byte*>(data);
        m_out.insert(m_out.end(), first, first + bytes);
    }
    void appendList(const void* data, size_t count, size_t itemBytes) {
        const auto stored = static_cast<uint32_t>(count);
        append(&stored, sizeof stored);
        append(data, count * itemBytes);
    }
    std::vector<std::byte>& m_out;
};

/// Reads fields back, bounds-checked; `name` is the file's, for messages.
class Decoder {
  public:
    Decoder(const std::vector<std::byte>& bytes, size_t& offset, const std::string& name)
        : m_bytes(bytes)
        , m_offset(offset)
        , m_name(name) {}

    template <class Value>
    void operator()(Value& value) {
        take(&value, sizeof value);
    }
    void operator()(std::string& text) {
        text.resize(takeCount(1));
        take(text.data(), text.size());
        if (text.find('\0') != std::string::npos) fail("a name holds a zero byte");
    }
    template <class Item>
    void operator()(std::vector<Item>& list) {
        list.resize(takeCount(sizeof(Item)));
        take(list.data(), list.size() * sizeof(Item));
    }
    [[noreturn]] void fail(const char* what) const {
        throw ContentError(formatText("%s: damaged recording: %s; record it again", m_name.c_str(), what));
    }

  private:
    void take(void* data, size_t bytes) {
        if (bytes > m_bytes.size() - m_offset) fail("an event is cut off");
        if (bytes > 0) std::memcpy(data, m_bytes.data() + m_offset, bytes);
        m_offset += bytes;
    }
    /// Checked against what is left before anything is allocated.
    size_t takeCount(size_t itemBytes) {
        uint32_t count = 0;
        take(&count, sizeof count);
        if (count > (m_bytes.size() - m_offset) / itemBytes) fail("a list is longer than its frame");
        return count;
    }
    const std::vector<std::byte>& m_bytes;
    size_t& m_offset;
    const std::string& m_name;
};

} // namespace q3rt
