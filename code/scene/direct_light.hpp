#pragma once
// Direct light at a point on the CPU, in luxel units: what the extracted lights give, shadows included. A reference for
// tools and tests; the renderers have their own shaders. Formulas: how the maps' light was baked (docs/lights.md).

#include <random>
#include <vector>

#include "scene/light_occluders.hpp"
#include "scene/lights.hpp"

namespace q3rt {

/// Parts of the irradiance, luxel units, colour included.
struct DirectLight {
    vec3 surfaces{0}, suns{0}, sky{0}, points{0};
    vec3 total() const { return surfaces + suns + sky + points; }
};

struct DirectLightSettings {
    int shadowRaysPerLight = 4; ///< toward each triangle light that faces the point
    int skyRays = 64;           ///< over the hemisphere, only where the map's skies emit
};

/// Form factor (0 to 1) of a triangle at a point with unit normal: the part above the point's horizon, unshadowed.
/// Lambert's contour integral (Baum, Rushmeier and Winget 1989, eq. 6), in double; exact but for rounding.
double triangleFormFactor(const vec3& point, const vec3& normal, const vec3 corner[3]);

class DirectLightTracer {
  public:
    DirectLightTracer(const World& world, const MaterialLibrary& materials, const LightSet& lights);

    /// `origin` lies off the surface already. Unbiased over the generator's draws.
    DirectLight at(const vec3& origin, const vec3& normal, const DirectLightSettings& settings,
                   std::mt19937& random) const;

  private:
    const LightSet& m_lights;
    LightOccluders m_occluders;
    std::vector<vec3> m_radiosity, m_upperRadiosity; ///< of skies, by surface

    bool reachesSky(const vec3& origin, const vec3& direction, int& sky) const;
    vec3 surfaceLight(const vec3& origin, const vec3& normal, int rays, std::mt19937& random) const;
    vec3 sunLight(const vec3& origin, const vec3& normal, std::mt19937& random) const;
    vec3 skyLight(const vec3& origin, const vec3& normal, int rays, std::mt19937& random) const;
    vec3 pointLight(const vec3& origin, const vec3& normal) const;
};

} // namespace q3rt
