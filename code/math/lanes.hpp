#pragma once
// Four numbers in a SIMD register, for inner loops. Comparisons give -1 in a lane where they hold, else 0.

#include <bit>
#include <cstdint>
#include <cstring>

// Of a function: made twice, and the processor's own set of instructions decides which one runs. Results are the same:
// neither joins a product and a sum.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define Q3RT_NEWER_PROCESSORS_TOO __attribute__((target_clones("avx2", "default")))
#else
#define Q3RT_NEWER_PROCESSORS_TOO
#endif

namespace q3rt {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

inline Float4 minimum(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 maximum(Float4 a, Float4 b) { return a > b ? a : b; }

inline Float4 loadFloat4(const void* from) {
    Float4 result;
    std::memcpy(&result, from, sizeof(result));
    return result;
}

inline Float4 magnitude(Float4 a) { return std::bit_cast<Float4>(std::bit_cast<Int4>(a) & 0x7fffffff); }

/// |a| < 2^31.
inline Float4 roundDown(Float4 a) {
    const Float4 whole = __builtin_convertvector(__builtin_convertvector(a, Int4), Float4);
    return whole > a ? whole - 1.0f : whole;
}
inline Float4 roundUp(Float4 a) { return -roundDown(-a); }

/// Rows become columns.
inline void transpose(Float4& a, Float4& b, Float4& c, Float4& d) {
    const Float4 lowAb = __builtin_shufflevector(a, b, 0, 4, 1, 5), highAb = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Float4 lowCd = __builtin_shufflevector(c, d, 0, 4, 1, 5), highCd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    a = __builtin_shufflevector(lowAb, lowCd, 0, 1, 4, 5);
    b = __builtin_shufflevector(lowAb, lowCd, 2, 3, 6, 7);
    c = __builtin_shufflevector(highAb, highCd, 0, 1, 4, 5);
    d = __builtin_shufflevector(highAb, highCd, 2, 3, 6, 7);
}

} // namespace q3rt
