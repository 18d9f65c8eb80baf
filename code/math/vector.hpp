#pragma once
// Vector names used everywhere (GLM behind them). World axes: X forward at yaw 0, Y left, Z up; unit: Quake unit (qu).
// Transforms are named destinationFromSource.

#include <cstdint>
#include <limits>

#include <glm/glm.hpp>

namespace q3rt {

using glm::dvec3;
using glm::mat3;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using U8vec4 = glm::tvec4<uint8_t>;
using glm::ivec3;

/// Points p with dot(normal, p) = distance.
struct Plane {
    vec3 normal{0.0f};
    float distance = 0.0f;
};

/// Axis-aligned box; empty until something is added.
struct Bounds {
    vec3 mins{std::numeric_limits<float>::max()};
    vec3 maxs{std::numeric_limits<float>::lowest()};

    void add(const vec3& point) {
        mins = glm::min(mins, point);
        maxs = glm::max(maxs, point);
    }
    void add(const Bounds& other) {
        mins = glm::min(mins, other.mins);
        maxs = glm::max(maxs, other.maxs);
    }
    bool empty() const { return mins.x > maxs.x; }
};

/// An orthogonal (perhaps scaled) frame: axis[0..2] = forward, left, up.
struct Orientation {
    vec3 origin{0.0f};
    vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

} // namespace q3rt
