#pragma once
// Single rays through Embree's robust mode: the reference of our own trees.

#include <cstdint>
#include <memory>
#include <span>

#include "math/vector.hpp"

namespace q3rt::test {

struct EmbreeHit {
    bool hit = false;
    float t = 0; ///< in units of |direction|
    uint32_t triangle = 0;
};

class EmbreeTracer {
  public:
    /// `positions`: 3 a triangle.
    explicit EmbreeTracer(std::span<const vec3> positions);
    ~EmbreeTracer();
    EmbreeTracer(const EmbreeTracer&) = delete;
    EmbreeTracer& operator=(const EmbreeTracer&) = delete;

    /// Closest hit in (0, tMax).
    EmbreeHit closest(const vec3& origin, const vec3& direction, float tMax) const;
    /// Is anything in (0, tMax)?
    bool occluded(const vec3& origin, const vec3& direction, float tMax) const;

  private:
    struct Handles;
    std::unique_ptr<Handles> m_handles;
};

} // namespace q3rt::test
