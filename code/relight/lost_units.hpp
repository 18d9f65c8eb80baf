#pragma once
// Between the fit's strengths and the numbers of scripts and entities (spec of baked light).

#include "relight/light_scene.hpp"

namespace q3rt {

/// Intensity of a point light of value 1.
inline constexpr float kIntensityOfValue = 7500;

/// What a point light, or a triangle of a surface that shines, gives to a luxel, of its largest channel, is left out at
/// or below this, luxel units: q3map2 -fast does so, and most of the 13 maps whose source is known agree best with this
/// very value (docs/lost_light.md).
inline constexpr float kFaintestLight = 1;

/// Radiosity of a script's value 1: q3map_surfacelight, q3map_skylight.
inline float radiosityOfValue(EmitterKind::Type type) { return type == EmitterKind::Type::SkyDome ? 0.5f : 0.75f; }

} // namespace q3rt
