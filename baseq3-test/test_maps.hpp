#pragma once
// The maps of baseq3-test and everything a test has to know about them.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "baseq3-test/box_map.hpp"

namespace q3rt {

/// Display value of every wall texel, so that albedo is exactly 153 / 255 = 0.6.
inline constexpr int kTestWallByte = 153;
inline constexpr double kTestWallAlbedo = kTestWallByte / 255.0;

/// maps/room_square_light.bsp: a closed room with one square light in the middle of its ceiling. Nothing hides
/// anything: irradiance at every point is 0.75 V rectangleFormFactor(point, normal, light corners), in luxel units.
namespace squareLightRoom {
inline constexpr const char* kName = "room_square_light";
inline constexpr IntBox kRoom{{-256, -256, 0}, {256, 256, 256}};
inline constexpr IntBox kLight{{-64, -64, 256}, {64, 64, 256}};
inline constexpr float kSurfaceLight = 1000.0f; ///< V
/// Luxel units.
double computeIrradiance(const dvec3& point, const dvec3& normal);
} // namespace squareLightRoom

/// maps/corridor_three_clusters.bsp: two rooms and an S-shaped corridor between them, a light in each. Cluster 0 (red
/// light) and cluster 2 (blue light) see the corridor, cluster 1 (green light), but not each other.
namespace threeClusterCorridor {
inline constexpr const char* kName = "corridor_three_clusters";
inline constexpr int kClusterCount = 3;
} // namespace threeClusterCorridor

BoxMap describeSquareLightRoom();
BoxMap describeThreeClusterCorridor();

/// All files of the game folder: maps, shader script, textures.
std::vector<std::pair<std::string, std::vector<std::byte>>> buildTestGameFiles();

} // namespace q3rt
