#pragma once
// The light table: which lights a point may see, by its cluster and its normal, and how much each is likely to give.
// A light is only left out of a row where it gives exactly nothing: triangles are clipped through the BSP, so that all
// clusters that they touch are known, not just those of their corners.

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "scene/lights.hpp"
#include "shaders/shared/rt_lights.h"

namespace q3rt {

/// What the table knows of a light.
struct RowLight {
    vec3 corner[3];      ///< a point light: all the same
    vec3 normal{0};      ///< lit side; 0: all sides
    float strength = 0;  ///< irradiance x distance^2 head on, luxel units qu^2, sum of the channels
    float radiusQu = 0;  ///< of a sphere around the centre that holds it at any time
    float reachQu = 0;   ///< it moves so far from here at most; infinite: it may be anywhere
    float nearestQu = 0; ///< it is no brighter nearer than this
    float farthestQu = std::numeric_limits<float>::infinity(); ///< it gives nothing farther away
    vec3 center() const { return (corner[0] + corner[1] + corner[2]) / 3.0f; }
};
/// Triangle lights, then point lights: the numbers that entries have.
std::vector<RowLight> describeRowLights(std::span<const TriangleLight> triangles, std::span<const PointLight> points);

struct RowPoint {
    vec3 position{0}; ///< on a surface
    vec3 normal{0};   ///< unit, of the side that is the class's; in class 0 the front
};
/// The lit surfaces of one cluster, or of one class of them.
struct RowPoints {
    std::vector<RowPoint> points;                    ///< a few, by area
    float plane = std::numeric_limits<float>::max(); ///< class 1 and up: the least distance along the normal
    double area = 0;
};
using ClusterPoints = std::array<RowPoints, kNormalClassCount>;

struct LightRows {
    std::vector<RtLightRow> rows; ///< as shaders/shared/rt_lights.h numbers them
    std::vector<RtLightEntry> entries;
    std::vector<ClusterPoints> points; ///< by cluster; behind the last one, in class 0, the whole world

    const RtLightRow& ofCluster(size_t cluster) const { return rows[cluster * kNormalClassCount]; }
    const RtLightRow& outside() const { return rows.back(); }
};

/// One of a row's facing lights at random from 32 bits, as the shaders draw it, and 1 / its probability.
struct DrawnLight {
    uint32_t light = 0;
    float weight = 0;
};
DrawnLight drawLight(const LightRows& rows, const RtLightRow& row, uint32_t bits);

/// The row's facing lights are chosen in proportion to `seen` too from here on, one for each, (0, 1].
void followSight(LightRows& rows, const RtLightRow& row, std::span<const float> seen);

/// The same map and lights give the same table, whatever the number of threads.
LightRows buildLightRows(const World& world, const MaterialLibrary& materials, std::span<const RowLight> lights);

} // namespace q3rt
