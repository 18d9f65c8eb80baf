#pragma once
// Rays on the CPU through the very text that the shaders run (shaders/trace/bvh_traverse.glsl): for tools that look at
// baked light, and for tests. One static structure, no instances.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "accel/bvh.hpp"

namespace q3rt {

struct CpuHit {
    float t = 0;           ///< in units of |direction|
    uint32_t triangle = 0; ///< as given to the constructor
    vec2 barycentric{0};   ///< weights of corners 1 and 2
    bool frontFace = false;
};

class CpuTracer {
  public:
    /// `positions`: 3 a triangle. `opaque`: one entry a triangle, 0: `accept` is asked; empty: all opaque.
    explicit CpuTracer(std::span<const vec3> positions, std::span<const uint8_t> opaque = {},
                       const BvhBuildSettings& settings = {.reinsert = true});

    /// Asked of triangles that are not opaque, possibly by several threads at once; unset: they count.
    std::function<bool(uint32_t triangle, const vec2& barycentric)> accept;

    /// Closest hit in (tMin, tMax); false if none. Safe to call from several threads.
    bool closest(const vec3& origin, const vec3& direction, float tMin, float tMax, CpuHit& hit) const;
    /// Is anything in (0, tMax)?
    bool occluded(const vec3& origin, const vec3& direction, float tMax) const;

    const Bvh& bvh() const { return m_bvh; }

  private:
    Bvh m_bvh;
    std::vector<BvhTriangle> m_triangles;
    Bvh m_scene; ///< of the one instance
    BvhInstance m_instance{};
};

} // namespace q3rt
