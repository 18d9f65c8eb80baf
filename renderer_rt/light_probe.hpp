#pragma once
// What the lights of the tables give at a point of the map, by rays on the processor: shadows included, no bounces.

#include <array>
#include <memory>
#include <random>
#include <span>

#include "accel/cpu_tracer.hpp"
#include "renderer_rt/world_lights.hpp"

namespace q3rt {

/// By direction: an axis, the opposite one, four across.
using ProbeWays = std::array<vec3, 6>;

/// What of a map stops the probes' rays. The same for all lights.
class ProbeGeometry {
  public:
    ProbeGeometry(const World& world, const MaterialLibrary& materials);
    ProbeGeometry(const ProbeGeometry&) = delete;
    ProbeGeometry& operator=(const ProbeGeometry&) = delete;
    /// Nothing between a point and the end of the way from it.
    bool isFree(const vec3& point, const vec3& way) const { return !m_tracer->occluded(point, way, 1.0f); }
    bool seesSky(const vec3& point, const vec3& direction) const;

  private:
    std::unique_ptr<CpuTracer> m_tracer;
    // By triangle of the tracer.
    std::vector<char> m_isSky;
    std::vector<float> m_cover; ///< share of it that stops light
    float m_farQu;
};

/// All that it is made of must outlive it; which rows, nodes and lights the tables have must stay.
class LightProbe {
  public:
    struct Flux;

    LightProbe(const World& world, const ProbeGeometry& geometry, const LightTables& tables)
        : m_world(world)
        , m_geometry(geometry)
        , m_tables(tables) {}

    struct Seen {
        ProbeWays irradiance{}; ///< of surfaces that face the ways, luxel units
        float sunSeen = 0;      ///< share of the suns' light that arrives; of none: 0
    };
    /// An unbiased estimate with any number of shadow rays to the lights of the point's row, and one to each sun.
    /// `axis`: of unit length.
    Seen look(const vec3& point, const vec3& axis, uint32_t rayCount, std::mt19937& random) const;

    /// Which lights belong together: the kind of each light of the tables, triangles, then points, then suns.
    struct Kinds {
        std::vector<uint32_t> ofLight;
        size_t count = 0;
    };
    /// What each kind gives to a surface that faces `normal`, into `irradiance`: an unbiased estimate with `rayCount`
    /// shadow rays to the lights of each kind, and one to each sun.
    void lookByKind(const vec3& point, const vec3& normal, const Kinds& kinds, uint32_t rayCount, std::mt19937& random,
                    std::span<vec3> irradiance) const;

    /// What one sample of a light of the rows gives to a surface, luxel units, sum of the channels.
    struct Arrival {
        float given = 0;   ///< if nothing were in the way
        float arrives = 0; ///< `given`, or nothing
    };
    Arrival sample(const vec3& point, const vec3& normal, uint32_t light, float u, float v) const;

  private:
    const RtLightRow& rowAt(const vec3& point) const;
    /// Of one sample of a light, as if nothing were in the way.
    Flux lookAt(const vec3& point, uint32_t light, float u, float v) const;
    /// The same; its share is 0 if something is.
    Flux traceSample(const vec3& point, uint32_t light, float u, float v) const;
    void addRow(const vec3& point, const RtLightRow& row, const ProbeWays& ways, uint32_t rayCount,
                std::mt19937& random, ProbeWays& sum) const;
    void addSuns(const vec3& point, const ProbeWays& ways, Seen& seen) const;

    const World& m_world;
    const ProbeGeometry& m_geometry;
    const LightTables& m_tables;
};

} // namespace q3rt
