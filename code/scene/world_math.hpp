#pragma once
// Small numeric helpers of the scene whose exact results show in the picture.

#include <bit>
#include <cstdint>

#include "math/vector.hpp"
#include "shaders/shared/vertex.h"

namespace q3rt {

/// The one-step reciprocal square root of the original (relative error up to 0.18 %): content is lit and clipped with
/// it.
inline float fastInverseSqrt(float value) {
    const auto bits = std::bit_cast<uint32_t>(value);
    const float guess = std::bit_cast<float>(0x5f3759dfu - (bits >> 1));
    return guess * (1.5f - 0.5f * value * guess * guess);
}

/// Zero stays zero (the estimate is finite there).
inline vec3 fastNormalize(const vec3& v) { return v * fastInverseSqrt(glm::dot(v, v)); }

/// Exact; the zero vector stays zero.
inline vec3 normalizeOrZero(const vec3& v) {
    const float length = glm::length(v);
    return length > 0.0f ? v / length : vec3(0.0f);
}

inline uint32_t packColor(const U8vec4& c) {
    return static_cast<uint32_t>(c.r) | static_cast<uint32_t>(c.g) << 8 | static_cast<uint32_t>(c.b) << 16 |
           static_cast<uint32_t>(c.a) << 24;
}

inline U8vec4 unpackColor(uint32_t c) {
    return {static_cast<uint8_t>(c), static_cast<uint8_t>(c >> 8), static_cast<uint8_t>(c >> 16),
            static_cast<uint8_t>(c >> 24)};
}

/// Direction of the normal of a triangle on the side from which it looks clockwise: the side that front-sided
/// materials show. Length = twice the area; zero for degenerate triangles.
inline vec3 clockwiseCross(const vec3& a, const vec3& b, const vec3& c) { return glm::cross(c - a, b - a); }

} // namespace q3rt
