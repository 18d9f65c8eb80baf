#pragma once
// Directions for rays: low-discrepancy points, turned by a hash of what asks. The same question, the same directions.

#include <cmath>
#include <cstdint>
#include <numbers>

#include "math/vector.hpp"

namespace q3rt {

/// A well-mixed number (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", PCG).
inline uint32_t hashOf(uint32_t value) {
    const uint32_t state = value * 747796405u + 2891336453u;
    const uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

inline float unitOf(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// Point `i` of a sequence in [0, 1)^2 for stream `key`: Roberts' R2 sequence, turned by the key.
inline vec2 planePoint(uint32_t i, uint32_t key) {
    // 2^32 / plastic number, and / its square.
    const uint32_t x = i * 3242174889u + hashOf(key), y = i * 2447445414u + hashOf(key ^ 0x9e3779b9u);
    return {unitOf(x), unitOf(y)};
}

/// Any two unit vectors that complete a frame (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
inline void completeFrame(const vec3& n, vec3& tangent, vec3& bitangent) {
    const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    tangent = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
}

/// Density proportional to the cosine with the normal.
inline vec3 cosineDirection(const vec3& normal, const vec2& random) {
    vec3 tangent, bitangent;
    completeFrame(normal, tangent, bitangent);
    const float radius = std::sqrt(random.x), angle = 2 * std::numbers::pi_v<float> * random.y;
    return radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent +
           std::sqrt(std::max(0.0f, 1 - random.x)) * normal;
}

/// Uniform over the sphere.
inline vec3 sphereDirection(const vec2& random) {
    const float z = 1 - 2 * random.x, radius = std::sqrt(std::max(0.0f, 1 - z * z)),
                angle = 2 * std::numbers::pi_v<float> * random.y;
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Uniform over the cone around a unit axis.
inline vec3 coneDirection(const vec3& axis, float halfAngleRadians, const vec2& random) {
    vec3 tangent, bitangent;
    completeFrame(axis, tangent, bitangent);
    const float cosine = 1 - random.x * (1 - std::cos(halfAngleRadians)),
                sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine)), angle = 2 * std::numbers::pi_v<float> * random.y;
    return sine * std::cos(angle) * tangent + sine * std::sin(angle) * bitangent + cosine * axis;
}

} // namespace q3rt
