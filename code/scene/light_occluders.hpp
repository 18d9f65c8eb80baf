#pragma once
// What stops light on its way, as the map compilers saw it: for tools and tests that trace baked light on the CPU.

#include <memory>
#include <vector>

#include "accel/cpu_tracer.hpp"
#include "scene/world.hpp"

namespace q3rt {

struct OccluderHit {
    float t = 0; ///< in units of |direction|
    uint32_t surface = 0;
    uint32_t firstIndex = 0; ///< of the triangle in World::indices
    vec2 barycentric{0};     ///< weights of corners 1 and 2
};

/// The drawn surfaces of the world model but translucent ones; alpha-shadowed ones by their texture.
class LightOccluders {
  public:
    LightOccluders(const World& world, const MaterialLibrary& materials);

    bool closest(const vec3& origin, const vec3& direction, float tMax, OccluderHit& hit) const;
    /// Is anything in (0, tMax)?
    bool occluded(const vec3& origin, const vec3& direction, float tMax) const {
        return m_tracer->occluded(origin, direction, tMax);
    }
    bool isSky(uint32_t surface) const { return m_isSky[surface]; }
    /// Longer than any line inside the map, qu.
    float farQu() const { return m_farQu; }

  private:
    struct Occluder {
        uint32_t surface;
        uint32_t firstIndex;
    };
    const World& m_world;
    const MaterialLibrary& m_materials;
    std::vector<Occluder> m_occluders;
    std::vector<bool> m_isSky; ///< by surface
    std::unique_ptr<CpuTracer> m_tracer;
    float m_farQu = 0;

    bool letsLightPass(uint32_t triangle, const vec2& barycentric) const;
};

} // namespace q3rt
