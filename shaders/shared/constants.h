// Mathematical constants, units and error bounds, each once, for C++ and GLSL.
#ifndef Q3RT_SHARED_CONSTANTS_H
#define Q3RT_SHARED_CONSTANTS_H
#include "types.h"
SHARED_BEGIN

SHARED_FLOAT kPi = 3.14159265358979f;
SHARED_FLOAT kTwoPi = 6.28318530717959f;

// Irradiance that shows a texture at its own brightness, luxel units: the engine shows texture x luxel x 4 / 255.
SHARED_FLOAT kWhiteIrradiance = 63.75f;

// The engine adds 32 of 255 to all light that falls on a model from around: no model is darker.
SHARED_FLOAT kModelLeastLight = 0.125490196f;

// Closest distance of the map compilers' inverse-square law, qu. A light nearer than this is no brighter.
SHARED_FLOAT kLightMinDistanceQu = 16.0f;

// Width of the border of a spot light's disc in which the map compilers let it fade, qu.
SHARED_FLOAT kSpotBorderQu = 32.0f;

// The engine's dynamic light adds colour x 4000 / (255 d^2), d in texels of radius / 16: in qu (4000 / (255 x 256)) x
// (radius / d)^2 of a texture's own brightness. Times kWhiteIrradiance: luxel units per radius^2.
SHARED_FLOAT kDynamicLightIntensity = 3.90625f;

// u of binary32, round to nearest: |fl(x) - x| <= u |x|.
SHARED_FLOAT kUnitRoundoff = 5.9604644775390625e-8f;

// Largest binary32 number below 1.
SHARED_FLOAT kBelowOne = 0.999999940395355f;

// Roundings, gamma(n) = n u / (1 - n u) (Higham 2002, lemma 3.1; Pharr, Jakob, Humphreys 2016, section 3.9).
//
// A hit point is rebuilt as p = v0 + (b1 (v1 - v0) + b2 (v2 - v0)). Barycentrics need not be exact: any pair gives a
// point of the plane. Each edge has 1 rounding, each product 1, their sum 1: gamma(3) of b1 |v1 - v0| + b2 |v2 - v0|.
// The last sum rounds once, by u |p|: far from the origin that alone is left.
SHARED_FLOAT kEdgeSumError = 1.7881397e-7f; // gamma(3)
// The intersector that tests the next ray against the same triangle subtracts the origin from its corners (1), makes
// the normal of the edges (1, 2 in each product and difference), three products and two sums with it (5): gamma(9) of
// the triangle's extent in each component would do for a right angle; an extent is at least 1/sqrt(3) of an edge.
SHARED_FLOAT kOwnTriangleError = 4.7683738e-7f; // gamma(8)
// Of a place in the world: both of the above as a share of the whole point, for what is not rebuilt so.
SHARED_FLOAT kHitPointError = 4.7683738e-7f; // gamma(8)
// A rotation, perhaps with a scale, of a point: 3 products and 2 sums a component, on |row| |p|. Adding the place
// rounds once more, by u of the sum.
SHARED_FLOAT kTransformError = 1.7881397e-7f; // gamma(3)
// The way back into an instance: the place is subtracted (1), the rounded inverse (2) turns (3).
SHARED_FLOAT kInverseError = 3.5762808e-7f; // gamma(6)
// The same with a matrix, as drivers' intersectors have it: the inverse's entries (3), products and sums (4), on the
// point and on the place.
SHARED_FLOAT kMatrixInverseError = 4.1723271e-7f; // gamma(7)
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
