#include "truth/square_room.hpp"

#include <limits>

#include "baseq3-test/test_maps.hpp"

namespace q3rt::test {

RoomPoint findRoomPoint(const Camera& camera, int width, int height, double x, double y) {
    const dvec3 direction = rayDirection(camera, width, height, x, y), eye(camera.eye);
    RoomPoint result;
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        const bool high = direction[axis] > 0;
        const double wall = (high ? squareLightRoom::kRoom.maxs : squareLightRoom::kRoom.mins)[axis];
        const double t = (wall - eye[axis]) / direction[axis];
        if (t >= nearest) continue;
        nearest = t;
        result.position = eye + direction * t;
        result.normal = dvec3(0);
        result.normal[axis] = high ? -1 : 1;
    }
    result.onLight = result.normal.z < 0 && std::abs(result.position.x) <= squareLightRoom::kLight.maxs.x &&
                     std::abs(result.position.y) <= squareLightRoom::kLight.maxs.y;
    return result;
}

bool isInsideOneWall(const Camera& camera, int width, int height, int x, int y) {
    const dvec3 normal = findRoomPoint(camera, width, height, x + 0.5, y + 0.5).normal;
    for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
            const RoomPoint point = findRoomPoint(camera, width, height, x + 0.5 + dx, y + 0.5 + dy);
            if (point.normal != normal || point.onLight) return false;
        }
    return true;
}

} // namespace q3rt::test
