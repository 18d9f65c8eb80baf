#pragma once
// What every fuzz target needs: the input in the parsers' types, and the one exception that damaged content may raise.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "base/error.hpp"
#include "base/log.hpp"

namespace q3rt::fuzz {

inline std::span<const std::byte> asBytes(const uint8_t* data, size_t size) {
    return {reinterpret_cast<const std::byte*>(data), size};
}

inline std::string_view asText(const uint8_t* data, size_t size) { return {reinterpret_cast<const char*>(data), size}; }

/// Runs a parser: ContentError is the answer to damaged input, anything else escapes and counts as a crash.
template <typename Body>
int runParser(Body body) {
    static const bool quiet = (setLogSink([](LogLevel, std::string_view) {}), true);
    if (!quiet) std::abort();
    try {
        body();
    } catch (const ContentError&) {
        return 0;
    }
    return 0;
}

/// A promise of a parser about what it returns.
inline void require(bool promise) {
    if (!promise) std::abort();
}

} // namespace q3rt::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);
