#pragma once
// The check that the baked light makes possible: at random points of lightmapped faces, direct light from the extracted
// lights beside the map's own luxel. Says how much of a map's light survives in its data.

#include <functional>
#include <string>
#include <vector>

#include "scene/direct_light.hpp"

namespace q3rt {

struct Luxel {
    vec3 position{0}, normal{0};
    vec3 baked{0}; ///< lightmap bytes 0..255, bilinear, or vertex bytes, interpolated; no overbright shift
    int surface = -1;
};

/// Where the map compilers sampled it: a little off its face.
inline constexpr float kLuxelOffsetQu = 1;
inline vec3 samplePointOf(const Luxel& luxel) { return luxel.position + kLuxelOffsetQu * luxel.normal; }

/// Unit normal at a point of the triangle whose corners begin at World::indices[firstIndex], `weight` of each: that of
/// its vertices, or, where a compiler left them without, of the side from which the corners go clockwise. 0: it has
/// none.
vec3 normalAt(const World& world, uint32_t firstIndex, const vec3& weight);

/// Faces whose light counts: those with a lightmap, or also the flat ones that a compiler lit at their vertices, where
/// the material takes these colours as light.
enum class LuxelFaces { Lightmapped, AllBaked };

/// Points uniform by area over such faces of the world; sky, hidden and emissive faces and saturated luxels left out.
/// The same seed gives the same points.
std::vector<Luxel> sampleLuxels(const World& world, const MaterialLibrary& materials, LuxelFaces faces, size_t count,
                                uint32_t seed);

/// Area of these faces.
double luxelAreaQu2(const World& world, const MaterialLibrary& materials, LuxelFaces faces);

/// All in luxel units of the largest channel.
struct LuxelReport {
    size_t pointCount = 0;
    double meanTraced = 0, meanSurfaces = 0, meanSun = 0, meanSky = 0, meanPoints = 0, meanBaked = 0;
    double correlation = 0;    ///< Pearson, traced against baked; 0 where either is constant
    double slope = 0;          ///< least squares, traced as a function of baked
    double explainedShare = 0; ///< sum of min(traced, baked) / sum of baked
    double medianRatio = 0;    ///< traced / baked where traced > 25
};

/// `mayGoOn` is called again and again, from several threads; what it throws ends the work.
LuxelReport checkLuxels(const World& world, const MaterialLibrary& materials, const LightSet& lights, size_t count,
                        uint32_t seed, const std::function<void()>& mayGoOn = {});

} // namespace q3rt
