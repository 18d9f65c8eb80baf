#include "numerics/renderer/rooms.hpp"

#include <cmath>

#include "base/error.hpp"
#include "baseq3-test/bsp_writer.hpp"

namespace q3rt::test {
namespace {

constexpr const char* kWall = "textures/baseq3test/wall";
constexpr const char* kSquareLight = "textures/baseq3test/light_square";

IntBox movedBox(const IntBox& box, const ivec3& offset) { return {box.mins + offset, box.maxs + offset}; }

BoxMap emptyRoom() {
    BoxMap map = describeSquareLightRoom();
    map.panels.clear();
    return map;
}

} // namespace

BoxMap movedRoom(const ivec3& offset) {
    BoxMap map = describeSquareLightRoom();
    map.air[0].box = movedBox(map.air[0].box, offset);
    map.panels[0].rectangle = movedBox(map.panels[0].rectangle, offset);
    return map;
}

Bsp roomOfManyLights(int side) {
    Bsp bsp = buildBoxMap(describeSquareLightRoom());
    for (BspSurface& surface : bsp.surfaces) {
        if (bsp.shaders[static_cast<size_t>(surface.shader)].name != kSquareLight) continue;
        const std::vector<BspDrawVertex> corners(bsp.vertices.begin() + surface.firstVertex,
                                                 bsp.vertices.begin() + surface.firstVertex + 4);
        surface.firstVertex = static_cast<int>(bsp.vertices.size());
        surface.firstIndex = static_cast<int>(bsp.indices.size());
        for (int i = 0; i <= side * (side + 1) + side; ++i) {
            BspDrawVertex vertex = corners[0];
            const auto u = static_cast<float>(i % (side + 1)), v = static_cast<float>(i / (side + 1));
            vertex.position += (corners[1].position - corners[0].position) * (u / static_cast<float>(side)) +
                               (corners[3].position - corners[0].position) * (v / static_cast<float>(side));
            bsp.vertices.push_back(vertex);
        }
        for (int v = 0; v < side; ++v)
            for (int u = 0; u < side; ++u) {
                const int at = v * (side + 1) + u, below = at + side + 1;
                bsp.indices.insert(bsp.indices.end(), {at, at + 1, below + 1, at, below + 1, below});
            }
        surface.vertexCount = static_cast<int>(bsp.vertices.size()) - surface.firstVertex;
        surface.indexCount = static_cast<int>(bsp.indices.size()) - surface.firstIndex;
    }
    return bsp;
}

BoxMap furnaceRoom() {
    BoxMap map = emptyRoom();
    const IntBox& room = squareLightRoom::kRoom;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
            if (axis == 2 && !high) continue; // the floor
            IntBox side = room;
            (high ? side.mins : side.maxs)[axis] = (high ? room.maxs : room.mins)[axis];
            map.panels.push_back({side, kSquareLight, squareLightRoom::kSurfaceLight, vec3(1.0f)});
        }
    return map;
}

BoxMap darkRoom() { return emptyRoom(); }

BoxMap roomBesideLights() {
    BoxMap map = emptyRoom();
    const ivec3 aside(1024, 0, 0);
    map.air.push_back({movedBox(squareLightRoom::kRoom, aside), 1, kWall});
    map.panels.push_back(
        {movedBox(squareLightRoom::kLight, aside), kSquareLight, squareLightRoom::kSurfaceLight, vec3(1.0f)});
    return map;
}

void addLightShader(TestGame& game, const std::string& name, float surfaceLight) {
    game.addText("scripts/" + name.substr(name.rfind('/') + 1) + ".shader",
                 formatText("%s\n{\n\tq3map_surfacelight %g\n\tq3map_lightRGB 1 1 1\n\t{\n\t\tmap "
                            "textures/baseq3test/white.tga\n\t\trgbGen identity\n\t}\n}\n",
                            name.c_str(), double(surfaceLight)));
}

void addMap(TestGame& game, const std::string& name, const Bsp& map) {
    game.add("maps/" + name + ".bsp", writeBsp(map));
}

void addMap(TestGame& game, const std::string& name, const BoxMap& map) { addMap(game, name, buildBoxMap(map)); }

RoomRenderer::RoomRenderer(FileSource& files, const char* backend,
                           const std::vector<std::pair<std::string, std::string>>& settings)
    : m_harness(files, Q3RT_BUILD_DIR "/renderer_rt_x86_64.so", kRoomWidth, kRoomHeight) {
    m_harness.engine().showsMessages = false;
    for (const auto& [name, value] : std::initializer_list<std::pair<const char*, const char*>>{
             {"rt_backend", backend},
             {"rt_numRandomDL", "0"},
             {"rt_accumulate", "1"},
             {"rt_ambient", "0"},
             {"rt_tonemap", "1"}}) // the other curve clamps light before the radiance is written
        m_harness.set(name, value);
    for (const auto& [name, value] : settings)
        m_harness.set(name, value);
}

FloatImage RoomRenderer::draw(const std::string& map, const Camera& camera, int frames) {
    if (map != m_map) {
        if (!m_map.empty()) m_harness.engine().shutdown(false);
        m_harness.loadMap("maps/" + map + ".bsp");
        m_map = map;
    }
    return m_harness.radiance(camera, frames);
}

bool isFinite(const FloatImage& image) {
    for (const float value : image.rgb)
        if (!std::isfinite(value)) return false;
    return true;
}

} // namespace q3rt::test
