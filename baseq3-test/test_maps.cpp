#include "baseq3-test/test_maps.hpp"

#include "base/error.hpp"
#include "baseq3-test/bsp_writer.hpp"
#include "formats/image.hpp"

namespace q3rt {

namespace {

constexpr const char* kWallShader = "textures/baseq3test/wall";

struct CorridorLight {
    const char* shader;
    IntBox rectangle;
    float surfaceLight;
    vec3 color;
};
constexpr CorridorLight kCorridorLights[] = {
    {"textures/baseq3test/light_red", {{96, 96, 192}, {160, 160, 192}}, 2000.0f, {1.0f, 0.25f, 0.25f}},
    {"textures/baseq3test/light_green", {{464, 240, 192}, {496, 272, 192}}, 3000.0f, {0.25f, 1.0f, 0.25f}},
    {"textures/baseq3test/light_blue", {{864, 352, 192}, {928, 416, 192}}, 2000.0f, {0.25f, 0.25f, 1.0f}},
};

std::string makeSpawn(int x, int y, int z, int yawDegrees) {
    return formatText("{\n\"classname\" \"info_player_deathmatch\"\n\"origin\" \"%d %d %d\"\n\"angle\" \"%d\"\n}\n", x,
                      y, z, yawDegrees);
}

std::string makeWorldspawn(const char* message) {
    return formatText("{\n\"classname\" \"worldspawn\"\n\"message\" \"%s\"\n}\n", message);
}

std::string makeLightScript(const char* name, float surfaceLight, const vec3& color) {
    return formatText("%s\n{\n\tq3map_surfacelight %g\n\tq3map_lightRGB %g %g %g\n\tsurfaceparm nomarks\n\t{\n"
                      "\t\tmap textures/baseq3test/white.tga\n\t\trgbGen const ( %g %g %g )\n\t}\n}\n",
                      name, double(surfaceLight), double(color.r), double(color.g), double(color.b), double(color.r),
                      double(color.g), double(color.b));
}

std::string makeScript() {
    std::string script =
        formatText("// Made by q3rt-testmaps.\n%s\n{\n\t{\n\t\tmap $lightmap\n\t\trgbGen identity\n\t}\n\t{\n"
                   "\t\tmap textures/baseq3test/grey.tga\n\t\tblendFunc filter\n\t\trgbGen identity\n\t}\n}\n",
                   kWallShader);
    script += makeLightScript("textures/baseq3test/light_square", squareLightRoom::kSurfaceLight, vec3(1.0f));
    for (const CorridorLight& light : kCorridorLights)
        script += makeLightScript(light.shader, light.surfaceLight, light.color);
    return script;
}

std::vector<std::byte> makeTexture(int value) {
    constexpr int kSize = 8;
    return encodeTga24(kSize, kSize, std::vector<uint8_t>(3 * kSize * kSize, static_cast<uint8_t>(value)));
}

std::vector<std::byte> toBytes(const std::string& text) {
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return {data, data + text.size()};
}

} // namespace

double squareLightRoom::computeIrradiance(const dvec3& point, const dvec3& normal) {
    return 0.75 * double(kSurfaceLight) * rectangleFormFactor(point, normal, computeCorners(kLight, 2, -1));
}

BoxMap describeSquareLightRoom() {
    BoxMap map;
    map.air.push_back({squareLightRoom::kRoom, 0, kWallShader});
    map.panels.push_back(
        {squareLightRoom::kLight, "textures/baseq3test/light_square", squareLightRoom::kSurfaceLight, vec3(1.0f)});
    map.entities =
        makeWorldspawn("A room with one square light") + makeSpawn(-192, -192, 24, 45) + makeSpawn(192, 192, 24, 225);
    return map;
}

BoxMap describeThreeClusterCorridor() {
    BoxMap map;
    const std::pair<IntBox, int> boxes[] = {{{{0, 0, 0}, {256, 256, 192}}, 0},
                                            {{{256, 96, 0}, {448, 160, 192}}, 1},
                                            {{{448, 96, 0}, {512, 416, 192}}, 1},
                                            {{{512, 352, 0}, {768, 416, 192}}, 1},
                                            {{{768, 256, 0}, {1024, 512, 192}}, 2}};
    for (const auto& [box, cluster] : boxes)
        map.air.push_back({box, cluster, kWallShader});
    for (const CorridorLight& light : kCorridorLights)
        map.panels.push_back({light.rectangle, light.shader, light.surfaceLight, light.color});
    map.entities = makeWorldspawn("Two rooms that do not see each other") + makeSpawn(64, 128, 24, 0) +
                   makeSpawn(480, 256, 24, 90) + makeSpawn(960, 384, 24, 180);
    return map;
}

std::vector<std::pair<std::string, std::vector<std::byte>>> buildTestGameFiles() {
    return {
        {formatText("maps/%s.bsp", squareLightRoom::kName), writeBsp(buildBoxMap(describeSquareLightRoom()))},
        {formatText("maps/%s.bsp", threeClusterCorridor::kName), writeBsp(buildBoxMap(describeThreeClusterCorridor()))},
        {"scripts/baseq3test.shader", toBytes(makeScript())},
        {"textures/baseq3test/grey.tga", makeTexture(kTestWallByte)},
        {"textures/baseq3test/white.tga", makeTexture(255)}};
}

} // namespace q3rt
