// Lights by rule, and the table of lights by cluster.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "scene/lights_build.hpp"
#include "scene_fixture.hpp"
#include "support/game_data.hpp"

namespace q3rt::test {
namespace {

constexpr const char* kScript = R"(
textures/lamp
{
    q3map_surfacelight 1000
    q3map_lightRGB 0.5 0.25 0
    { map $whiteimage }
}
textures/lampback
{
    cull back
    q3map_surfacelight 1000
    { map $whiteimage }
}
textures/lampboth
{
    cull none
    q3map_surfacelight 1000
    q3map_lightimage textures/green.tga
    { map textures/red.tga }
}
textures/sky
{
    skyparms - 512 -
    q3map_surfacelight 200
    q3map_skylight 60 3
    q3map_sun 2 1 1 80 90 30
    { map textures/red.tga }
}
)";

class LightsTest : public testing::Test {
  protected:
    MemoryFiles m_files;
    std::unique_ptr<SceneLibraries> m_libraries;
    World m_world;

    void SetUp() override {
        m_files.addText("scripts/a.shader", kScript);
        m_files.addImage("textures/red.tga", {200, 0, 0, 255});
        m_files.addImage("textures/green.tga", {0, 100, 50, 255});
        m_libraries = std::make_unique<SceneLibraries>(m_files);
        m_world.bsp.leafs.resize(1);
        m_world.bsp.leafs[0].cluster = 0;
    }

    /// A right triangle of legs 8 and 4 in the plane z = 0, clockwise seen from above.
    void addTriangle(const char* material) {
        WorldSurface surface;
        surface.type = BspSurfaceType::TriangleSoup;
        surface.material = m_libraries->materials.find(material, lightmapContext::kByVertex);
        surface.firstVertex = static_cast<uint32_t>(m_world.vertices.size());
        surface.vertexCount = 3;
        surface.firstIndex = static_cast<uint32_t>(m_world.indices.size());
        surface.indexCount = 6; // the second triangle has no area
        const uint32_t first = surface.firstVertex;
        for (const vec3& corner : {vec3(0, 0, 0), vec3(0, 8, 0), vec3(4, 0, 0)}) {
            m_world.vertices.push_back(Vertex{corner});
        }
        m_world.indices.insert(m_world.indices.end(), {first, first + 1, first + 2, first, first, first + 2});
        m_world.surfaces.push_back(surface);
    }
};

TEST_F(LightsTest, SurfaceLightIsALambertianEmitterOfItsColour) {
    addTriangle("textures/lamp");
    const LightSet lights = extractLights(m_world, m_libraries->materials);
    ASSERT_EQ(lights.triangles.size(), 1u);
    EXPECT_EQ(lights.zeroAreaTriangles, 1u);
    const TriangleLight& light = lights.triangles[0];
    EXPECT_EQ(light.normal, vec3(0, 0, 1));
    EXPECT_FLOAT_EQ(light.areaQu2, 16);
    const float radiance = 0.75f * 1000 / std::numbers::pi_v<float>;
    EXPECT_NEAR(light.radiance.r, radiance, 1e-3f);
    EXPECT_NEAR(light.radiance.g, radiance * 0.5f, 1e-3f);
    EXPECT_EQ(light.radiance.b, 0);
    EXPECT_FALSE(light.twoSided);
}

TEST_F(LightsTest, LightLeavesTheSideThatShows) {
    addTriangle("textures/lampback");
    addTriangle("textures/lampboth");
    const LightSet lights = extractLights(m_world, m_libraries->materials);
    ASSERT_EQ(lights.triangles.size(), 2u);
    EXPECT_EQ(lights.triangles[0].normal, vec3(0, 0, -1));
    EXPECT_TRUE(lights.triangles[1].twoSided);
    EXPECT_NEAR(lights.triangles[1].radiance.g / lights.triangles[1].radiance.b, 2, 0.05f) << "the light image's mean";
    EXPECT_EQ(lights.triangles[1].radiance.r, 0);
}

TEST_F(LightsTest, SkyGivesASunAndSkyLightButNoTriangles) {
    addTriangle("textures/sky");
    addTriangle("textures/sky");
    const LightSet lights = extractLights(m_world, m_libraries->materials);
    EXPECT_TRUE(lights.triangles.empty());
    ASSERT_EQ(lights.suns.size(), 1u) << "once a sky, not once a surface";
    EXPECT_NEAR(glm::distance(lights.suns[0].direction, vec3(0, std::sqrt(0.75f), 0.5f)), 0, 1e-6f);
    EXPECT_NEAR(glm::distance(lights.suns[0].irradiance, vec3(80, 40, 40)), 0, 1e-4f);
    ASSERT_EQ(lights.skies.size(), 3u);
    EXPECT_FLOAT_EQ(lights.skies[0].radiosity, 150);
    EXPECT_FLOAT_EQ(lights.skies[1].radiosity, 30);
    EXPECT_TRUE(lights.skies[1].upperHemisphere);
}

TEST_F(LightsTest, LightEntities) {
    m_world.entities = parseEntities(R"({ "classname" "light" "origin" "1 2 3" "light" "200" "_color" "1 .5 0" }
        { "classname" "light" "origin" "0 0 100" "target" "t" "radius" "100" }
        { "classname" "light" "origin" "0 0 100" "target" "t" "_sun" "1" "light" "50" }
        { "classname" "info_null" "targetname" "t" "origin" "0 0 0" })");
    const LightSet lights = extractLights(m_world, m_libraries->materials);
    ASSERT_EQ(lights.points.size(), 2u);
    EXPECT_EQ(lights.points[0].intensity, vec3(7500 * 200, 7500 * 100, 0));
    EXPECT_FALSE(lights.points[0].spot);
    EXPECT_TRUE(lights.points[1].spot);
    EXPECT_NEAR(lights.points[1].cosOuter, std::sqrt(0.5f), 1e-6f);
    EXPECT_EQ(lights.points[1].direction, vec3(0, 0, -1));
    ASSERT_EQ(lights.suns.size(), 1u);
    EXPECT_EQ(lights.suns[0].direction, vec3(0, 0, 1));
}

/// Clusters of random points of a light, each moved off its plane both ways: what a wrong table would miss.
std::set<int> sampleClusters(const World& world, const TriangleLight& light, std::mt19937& random) {
    std::uniform_real_distribution<float> unit(0, 1);
    std::set<int> clusters;
    for (int i = 0; i < 64; ++i) {
        const float root = std::sqrt(unit(random)), v = unit(random);
        const vec3 point =
            light.corner[0] * (1 - root) + light.corner[1] * (root * (1 - v)) + light.corner[2] * (root * v);
        for (const float off : {-0.05f, 0.0f, 0.05f}) {
            const int cluster = world.clusterOf(point + light.normal * off);
            if (cluster >= 0) clusters.insert(cluster);
        }
    }
    return clusters;
}

/// Checks every pair of light and row of a map; returns the share of all pairs that the table lists.
double checkTable(FileSource& files, const std::string& map) {
    SceneLibraries libraries(files);
    const auto world = loadWorld(files, "maps/" + map + ".bsp", libraries.materials, WorldSettings{});
    const LightSet lights = extractLights(*world, libraries.materials);
    const LightTable table = buildLightTable(*world, lights, true);
    const auto clusters = static_cast<size_t>(world->bsp.clusterCount);
    EXPECT_EQ(table.offset.size(), clusters + 2);
    EXPECT_EQ(table.offset[clusters + 1] - table.offset[clusters], lights.triangles.size()) << "outside sees all";
    constexpr unsigned kSeed = 1;
    std::mt19937 random(kSeed);
    size_t required = 0, missing = 0;
    for (size_t i = 0; i < lights.triangles.size(); ++i) {
        const std::set<int> touched = sampleClusters(*world, lights.triangles[i], random);
        for (size_t row = 0; row < clusters; ++row) {
            const bool seen = std::any_of(touched.begin(), touched.end(), [&](int cluster) {
                return world->bsp.clusterVisible(static_cast<int>(row), cluster);
            });
            required += seen;
            missing += seen && !std::binary_search(table.lights.begin() + table.offset[row],
                                                   table.lights.begin() + table.offset[row + 1], i);
        }
    }
    EXPECT_EQ(missing, 0u) << map << ", seed " << kSeed;
    EXPECT_GT(required, 1000u);
    const size_t pairs = lights.triangles.size() * clusters, listed = table.offset[clusters];
    std::printf("%s: %zu lights, %zu clusters; %zu pairs of light and row must be listed, %zu of %zu are\n",
                map.c_str(), lights.triangles.size(), clusters, required, listed, pairs);
    return static_cast<double>(listed) / static_cast<double>(pairs);
}

TEST(LightTable, NeverMissesALightThatARowCanSee) {
    Q3RT_OPEN_GAME_DATA_OR_SKIP(files);
    TinyImageFiles tiny(*files);
    checkTable(tiny, "fan");
    EXPECT_LT(checkTable(tiny, "oa_spirit3"), 0.5) << "on a map of many rooms the table culls";
}

TEST(LightTable, WithoutCullingEveryRowHoldsAll) {
    World world;
    world.bsp.leafs.resize(1);
    world.bsp.clusterCount = 3;
    world.bsp.clusterRowBytes = 1;
    world.bsp.visibility = {1, 2, 4}; // each cluster sees itself only
    LightSet lights;
    lights.triangles.resize(5);
    EXPECT_EQ(buildLightTable(world, lights, false).lights.size(), 5u * 4);
    world.bsp.leafs[0].cluster = 1;
    const LightTable culled = buildLightTable(world, lights, true);
    EXPECT_EQ(culled.offset, (std::vector<uint32_t>{0, 0, 5, 5, 10}));
}

} // namespace
} // namespace q3rt::test
