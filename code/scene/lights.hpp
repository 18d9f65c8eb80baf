#pragma once
// Lights by rule, never by texture name. Units: luxel units (spec of baked light): irradiance 63.75 shows a texture at
// its own brightness; a surface light V is a Lambertian emitter of radiosity 0.75 V, radiance 0.75 V / pi.

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/world.hpp"
#include "shaders/shared/constants.h"
#include "shaders/shared/rt_lights.h"

namespace q3rt {

struct TriangleLight {
    vec3 corner[3]; ///< world space, clockwise seen from the lit side as the surface is
    vec3 normal{0}; ///< unit, toward the lit side
    float areaQu2 = 0;
    vec3 radiance{0}; ///< luxel units / pi, colour included
    bool twoSided = false;
    int surface = -1;      ///< world surface it came from
    uint32_t triangle = 0; ///< its number in that surface
    bool flipped = false;  ///< lit from behind: corners 1 and 2 are exchanged against the surface's
    int bspModel = 0;      ///< 0 world, else the submodel that moves it
    bool upward = false;   ///< only directions above the horizon shine (q3map_skylight)
    float reachQu = 0;     ///< deforms move it at most so far from here, at any time; may be infinite
    /// Irradiance of the largest channel at or below which it gives nothing, luxel units: isTooFaint(). 0: none.
    float faintest = 0;
    bool moves() const { return bspModel != 0 || reachQu > 0; }
};

/// Far enough for the light of its middle to stand for all of it: four times its size. `squared`: of the distance,
/// qu^2.
inline bool isFarFrom(const TriangleLight& light, float squared) {
    return squared > kFarTriangleSizes * kFarTriangleSizes * light.areaQu2;
}
/// Does the map compilers' rule leave it out at a point? Only far from it, by the unshadowed light of its middle: the
/// same for every way to sample it.
bool isTooFaint(const TriangleLight& light, const vec3& point, const vec3& normal);

struct SunLight {
    vec3 direction{0};  ///< toward the sun, unit
    vec3 irradiance{0}; ///< luxel units at normal incidence
    float halfAngleRadians = 0;
};

/// One drawn sky surface with q3map_surfacelight, or with q3map_skylight; one with both is in the list twice.
struct SkyLight {
    float radiosity = 0; ///< luxel units: irradiance of a surface that sees nothing but this sky
    vec3 color{1};       ///< largest component 1
    int surface = -1;
    /// From q3map_skylight: only directions above the horizon shine. Half its value: n suns that share the value,
    /// spread evenly over that hemisphere, give level ground this much.
    bool upperHemisphere = false;
};

struct PointLight {
    vec3 origin{0};
    vec3 intensity{0}; ///< 7500 V colour: irradiance = intensity cos / d^2, d at least 16
    bool spot = false;
    vec3 direction{0};
    float cosOuter = -1;
    /// Irradiance of the largest channel at or below which it gives nothing, luxel units (q3map2 -fast).
    float faintest = 0;
    /// Of the angle between a spot light's axis and its border.
    float tangent() const { return std::sqrt(std::max(0.0f, 1 - cosOuter * cosOuter)) / cosOuter; }
};

/// Share of a spot light's intensity that goes to a point: 1 inside its cone, falling to 0 over the border of the disc
/// that the cone cuts at the point's distance. `tangent` of the angle from its axis to its border.
inline float spotShare(const vec3& fromLight, const vec3& axis, float tangent) {
    const float along = glm::dot(fromLight, axis);
    if (!(along > 0)) return 0;
    return glm::clamp((tangent * along - glm::length(fromLight - along * axis)) / kSpotBorderQu, 0.0f, 1.0f);
}
inline float spotShare(const PointLight& light, const vec3& fromLight) {
    return spotShare(fromLight, light.direction, light.tangent());
}

struct LightSet {
    std::vector<TriangleLight> triangles;
    std::vector<SunLight> suns; ///< of drawn skies
    std::vector<SkyLight> skies;
    std::vector<PointLight> points; ///< surviving light entities
    vec3 ambient{0};                ///< irradiance that is the same everywhere; 0: there is none, or it is not known
    vec3 floor{0};                  ///< the least irradiance that a surface has
    size_t emissiveSurfaces = 0;    ///< that gave triangles
    size_t zeroAreaTriangles = 0;   ///< of emissive surfaces, left out: they give no light
};

/// The sky surfaces as triangle lights: each sky gives its light through its own surfaces, and only there.
std::vector<TriangleLight> skyTriangles(const World& world, const MaterialLibrary& materials, const LightSet& lights);

/// Normal and area from the corners; false if it has no area (then it gives no light).
bool measureTriangle(TriangleLight& light);

/// All lights of a map. Emissive surfaces are those drawn with q3map_surfacelight > 0 and no sky.
LightSet extractLights(const World& world, const MaterialLibrary& materials);

} // namespace q3rt
