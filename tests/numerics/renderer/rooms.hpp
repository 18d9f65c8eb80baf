#pragma once
// Maps for the extremes, from the description of baseq3-test's rooms: moved, with other lights, or with none.

#include <string>

#include "truth/square_room.hpp"
#include "truth/test_game.hpp"

namespace q3rt::test {

inline constexpr int kRoomWidth = 48, kRoomHeight = 36; ///< pixels
/// In the room with one square light; it sees three walls, the floor and the light.
inline const Camera kRoomCamera{.eye = {-200, -180, 100}, .pitch = 10, .yaw = 40};

/// The room with one square light, every coordinate moved by `offset`.
BoxMap movedRoom(const ivec3& offset);
/// The room with one square light, which is made of `side` x `side` squares of two triangles.
Bsp roomOfManyLights(int side);
/// The room with all walls and the ceiling of light, its floor of the wall's material: a white furnace.
BoxMap furnaceRoom();
/// A room without any light.
BoxMap darkRoom();
/// Two rooms that have nothing in common but one map: lights in the one, the camera's square room the other.
BoxMap roomBesideLights();

/// A light material: q3map_surfacelight `surfaceLight`. In a script of its own.
void addLightShader(TestGame& game, const std::string& name, float surfaceLight);
void addMap(TestGame& game, const std::string& name, const BoxMap& map);
void addMap(TestGame& game, const std::string& name, const Bsp& map);

/// The ray tracer with nothing left to chance but the points on the lights: all lights, no ambient term. Maps are drawn
/// one after the other.
class RoomRenderer {
  public:
    /// `settings` come on top.
    explicit RoomRenderer(FileSource& files, const char* backend = "compute",
                          const std::vector<std::pair<std::string, std::string>>& settings = {});
    /// Mean radiance of `frames` frames.
    FloatImage draw(const std::string& map, const Camera& camera, int frames);
    void set(const char* cvar, const char* value) { m_harness.set(cvar, value); }

  private:
    TraceHarness m_harness;
    std::string m_map;
};
/// None is NaN or infinite.
bool isFinite(const FloatImage& image);

} // namespace q3rt::test
