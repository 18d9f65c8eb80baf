// Lights by rule.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "scene/lights_build.hpp"
#include "scene_fixture.hpp"

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
    ASSERT_EQ(lights.skies.size(), 4u);
    EXPECT_FLOAT_EQ(lights.skies[0].radiosity, 150);
    EXPECT_FLOAT_EQ(lights.skies[1].radiosity, 30);
    EXPECT_TRUE(lights.skies[1].upperHemisphere);
    const std::vector<TriangleLight> shining = skyTriangles(m_world, m_libraries->materials, lights);
    ASSERT_EQ(shining.size(), 4u);
    EXPECT_FLOAT_EQ(shining[0].radiance.r, 150 / std::numbers::pi_v<float>);
    EXPECT_FALSE(shining[0].upward);
    EXPECT_TRUE(shining[1].upward);
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
    // The cone's disc is as large as the target is far; the last 32 units of its radius fade.
    EXPECT_EQ(spotShare(lights.points[1], {0, 0, -100}), 1);
    EXPECT_NEAR(spotShare(lights.points[1], {84, 0, -100}), 0.5, 1e-5);
    EXPECT_EQ(spotShare(lights.points[1], {101, 0, -100}), 0);
    EXPECT_EQ(spotShare(lights.points[1], {0, 0, 100}), 0);
    ASSERT_EQ(lights.suns.size(), 1u);
    EXPECT_EQ(lights.suns[0].direction, vec3(0, 0, 1));
}

} // namespace
} // namespace q3rt::test
