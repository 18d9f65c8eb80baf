#pragma once
// The parts of extractLights.

#include "scene/lights.hpp"

namespace q3rt {

/// Colour of the light that a material gives off, largest component 1: q3map_lightRGB, else the mean of the light
/// image, of the editor image, of the image of its own name, of the first stage's image. White if none of them exists.
vec3 lightColorOf(const Material& material, const MaterialLibrary& materials);
/// Angles of the compilers' suns: yaw counter-clockwise from +X, pitch above the horizon, degrees.
vec3 directionOfAngles(float yawDegrees, float pitchDegrees);
/// Surviving `light` entities: point and spot lights, and suns (`_sun`).
void addEntityLights(const std::vector<MapEntity>& entities, LightSet& lights);

} // namespace q3rt
