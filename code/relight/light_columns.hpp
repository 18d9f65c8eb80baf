#pragma once
// What sources of unit strength give to receivers, shadows included: the columns of the fit's matrix.

#include "relight/light_scene.hpp"

namespace q3rt {

/// Irradiance at receivers, ascending; those that get none are left out.
struct LightColumn {
    std::vector<uint32_t> receiver;
    std::vector<float> value;
    void append(size_t number, float irradiance) {
        if (!(irradiance > 0)) return;
        receiver.push_back(static_cast<uint32_t>(number));
        value.push_back(irradiance);
    }
};

/// A spot light's cone as map compilers have it: where it meets a surface the light fades over kSpotBorderQu inside the
/// circle that the cone cuts out.
struct LightCone {
    vec3 axis{0};     ///< unit; zero: a point light
    float radius = 0; ///< of the circle, at distance 1
    bool isPoint() const { return axis == vec3(0); }
};

/// One column a kind, for a radiosity of 1; empty for skies, see HemisphereRays. `faintest`, by kind: what a triangle
/// of radiosity 1 gives to a point is left out at or below this (scene/lights.hpp: isTooFaint); negative: the whole
/// column.
std::vector<LightColumn> traceEmitters(const LightScene& scene, const std::vector<LightReceiver>& receivers,
                                       const std::vector<float>& faintest);
/// For an irradiance of 1 at normal incidence.
LightColumn traceSun(const LightScene& scene, const std::vector<LightReceiver>& receivers, const SunLight& sun);
/// Irradiance of an unshadowed point light of intensity 1: cos / d^2, d at least 16 qu as the map compilers have it.
float pointIrradiance(const vec3& position, const vec3& normal, const vec3& origin);
/// For an intensity of 1. Points of receivers that would get `faintest` or less are dark, and of those that get little
/// fewer are sampled.
LightColumn tracePoint(const LightScene& scene, const std::vector<LightReceiver>& receivers, const vec3& origin,
                       float faintest);
/// A point light's column with a cone around it.
LightColumn withinCone(const std::vector<LightReceiver>& receivers, const vec3& origin, const LightCone& cone,
                       const LightColumn& column);

} // namespace q3rt
