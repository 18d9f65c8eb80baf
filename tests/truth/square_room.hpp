#pragma once
// The room with one square light as a camera sees it: what is behind a point of the picture, for its closed form.

#include "truth/picture_statistics.hpp"

namespace q3rt::test {

/// Where the ray through a point of the picture leaves the room.
struct RoomPoint {
    dvec3 position{0}, normal{0};
    bool onLight = false;
};

/// `width`, `height`: of the picture; `x`, `y`: the point, pixels.
RoomPoint findRoomPoint(const Camera& camera, int width, int height, double x, double y);
/// Is everything within two pixels the same wall and no light? The room has no shadows: its edges are all there is.
bool isInsideOneWall(const Camera& camera, int width, int height, int x, int y);

} // namespace q3rt::test
