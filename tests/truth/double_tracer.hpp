#pragma once
// An independent tracer in double precision: what the ray tracer's picture must converge to. Embree (robust mode) names
// candidate triangles only; the intersection that decides, the form factors and the shading are its own. It shares with
// the renderer the loaded map, the extracted lights and the rule that sorts materials into classes.

#include <functional>
#include <memory>
#include <optional>
#include <random>

#include "renderer_rt/surface_class.hpp"
#include "scene/lights.hpp"

namespace q3rt::test {

using glm::dvec2;

struct DoubleHit {
    double t = 0; ///< in units of |direction|
    uint32_t triangle = 0;
    uint32_t surface = 0; ///< world surface
    dvec2 barycentric{0}; ///< weights of corners 1 and 2
    dvec3 position{0};
    dvec3 normal{0};          ///< unit, shading, on the side that the ray came from
    dvec3 geometricNormal{0}; ///< unit, on the same side
};

/// Moves the vertices of deformed surfaces to where they are at time 0. Sprites stay.
void deformWorld(World& world, const MaterialLibrary& materials);

class DoubleTracer {
  public:
    DoubleTracer(const World& world, const MaterialLibrary& materials, const LightSet& lights);
    ~DoubleTracer();
    DoubleTracer(const DoubleTracer&) = delete;
    DoubleTracer& operator=(const DoubleTracer&) = delete;

    /// What the eye meets: the first solid, unless something see-through or a sprite may lie before it (then nullopt).
    std::optional<DoubleHit> look(const dvec3& origin, const dvec3& direction) const;

    /// Direct light in luxel units, all lights; of both sides where both show. The generator only places samples inside
    /// their strata.
    dvec3 irradiance(const DoubleHit& hit, std::mt19937& random) const;

    const WorldSurface& surfaceOf(const DoubleHit& hit) const { return m_world.surfaces[hit.surface]; }

  private:
    struct Triangle {
        uint32_t surface, firstIndex;
        SurfaceClass surfaceClass;
        bool turns; ///< a sprite: where it is depends on the eye, and it casts no shadow
    };
    /// Calls `visit` for triangles that the line may meet at t in [0, tMax], in any order, until it returns true.
    void visitCandidates(const dvec3& origin, const dvec3& direction, double tMax,
                         const std::function<bool(uint32_t triangle)>& visit) const;
    Bounds boundSprite(const WorldSurface& surface) const;
    dvec3 corner(uint32_t triangle, uint32_t k) const;
    bool intersect(uint32_t triangle, const dvec3& origin, const dvec3& direction, DoubleHit& hit) const;
    bool isCovered(const DoubleHit& hit) const;
    bool isOpen(const dvec3& from, const dvec3& way, double tMax) const;
    /// The sky that a ray reaches, -1 if something is in the way: index of the world surface.
    int findSky(const dvec3& from, const dvec3& direction) const;
    dvec3 sideIrradiance(const DoubleHit& hit, std::mt19937& random) const;
    dvec3 triangleLight(const DoubleHit& hit, const TriangleLight& light, int side, std::mt19937& random) const;
    dvec3 surfaceLight(const DoubleHit& hit, std::mt19937& random) const;
    dvec3 sunLight(const DoubleHit& hit, std::mt19937& random) const;
    dvec3 skyLight(const DoubleHit& hit, std::mt19937& random) const;
    dvec3 pointLight(const DoubleHit& hit) const;

    struct Embree;
    const World& m_world;
    const MaterialLibrary& m_materials;
    const LightSet& m_lights;
    std::vector<Triangle> m_triangles;
    std::vector<Bounds> m_sprites; ///< where they may be from any view
    std::unique_ptr<Embree> m_embree;
    double m_farQu = 0; ///< longer than any line inside the map
};

} // namespace q3rt::test
