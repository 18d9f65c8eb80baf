// Mathematical constants, units and error bounds, each once, for C++ and GLSL.
#ifndef Q3RT_SHARED_CONSTANTS_H
#define Q3RT_SHARED_CONSTANTS_H
#include "types.h"
#ifdef __cplusplus
#define SHARED_FLOAT inline constexpr float
#else
#define SHARED_FLOAT const float
#endif
SHARED_BEGIN

SHARED_FLOAT kPi = 3.14159265358979f;
SHARED_FLOAT kTwoPi = 6.28318530717959f;

// Irradiance that shows a texture at its own brightness, luxel units: the engine shows texture x luxel x 4 / 255.
SHARED_FLOAT kWhiteIrradiance = 63.75f;

// Closest distance of the map compilers' inverse-square law, qu. A light nearer than this is no brighter.
SHARED_FLOAT kLightMinDistanceQu = 16.0f;

// The engine's dynamic light adds colour x 4000 / (255 d^2), d in texels of radius / 16: in qu (4000 / (255 x 256)) x
// (radius / d)^2 of a texture's own brightness. Times kWhiteIrradiance: luxel units per radius^2.
SHARED_FLOAT kDynamicLightIntensity = 3.90625f;

// u of binary32, round to nearest: |fl(x) - x| <= u |x|.
SHARED_FLOAT kUnitRoundoff = 5.9604644775390625e-8f;

// Error of a hit point rebuilt as p = v0 + b1 (v1 - v0) + b2 (v2 - v0), per component, in units of
// s = |v0| + b1 |v1 - v0| + b2 |v2 - v0|. Each edge has 1 rounding, each product 1, their sum 1, the last sum 1:
// gamma(4) s holds for the point in the space of the triangle. Barycentrics need not be exact: any pair gives a point
// of the plane. The intersector that tests the next ray against the same triangle subtracts the origin (1), in an
// instance after transforming the ray (3): gamma(8) s. It then multiplies differences across components (shear, cross
// products), so that an error in any component reaches all: gamma(8) times the triangle's extent is added to each.
// gamma(n) = n u / (1 - n u) (Higham 2002, lemma 3.1; Pharr, Jakob, Humphreys 2016, section 3.9).
SHARED_FLOAT kHitPointError = 4.7683738e-7f; // gamma(8)
// A rigid or scaled transform of a point: 3 products and 3 sums a component, on |row| |p| + |t|.
SHARED_FLOAT kTransformError = 1.7881397e-7f; // gamma(3)
// Refractive indices against air, visible light.
SHARED_FLOAT kWaterIndex = 1.333f;
SHARED_FLOAT kGlassIndex = 1.5f;

// Distance along a unit direction between two hits that are the same point: both have kHitPointError in position, and
// t itself 3 roundings more on the whole path.
SHARED_FLOAT kSameDistanceError = 1.1324895e-6f; // gamma(19)

// Sines below this count as this one where an error across a surface is turned into one along the ray.
SHARED_FLOAT kGrazingCosine = 0.015625f; // 1/64

SHARED_END
#endif
