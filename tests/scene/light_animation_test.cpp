// The light of animated emitters follows what they show, with the mean that was baked.

#include <cmath>

#include <gtest/gtest.h>

#include "scene/light_animation.hpp"
#include "scene_fixture.hpp"

namespace q3rt::test {
namespace {

constexpr const char* kScript = R"(
textures/steady
{
    q3map_surfacelight 100
    {
        map textures/red.tga
        tcMod scroll 1 1
    }
}
textures/blinking
{
    q3map_surfacelight 100
    {
        map textures/red.tga
        rgbGen wave square 0.5 0.5 0 1
    }
}
textures/lamp
{
    q3map_surfacelight 100
    {
        map $lightmap
    }
    {
        map textures/red.tga
        blendFunc filter
    }
    {
        map textures/green.tga
        blendFunc add
        rgbGen wave sin 0.5 0.25 0 2
    }
}
textures/pictures
{
    q3map_surfacelight 100
    {
        animMap 10 textures/red.tga textures/green.tga
    }
}
)";

class LightAnimationTest : public testing::Test {
  protected:
    MemoryFiles m_files;
    std::unique_ptr<SceneLibraries> m_libraries;
    void SetUp() override {
        m_files.addText("scripts/a.shader", kScript);
        m_files.addImage("textures/red.tga", {200, 0, 0, 255});
        m_files.addImage("textures/green.tga", {0, 100, 50, 255});
        m_libraries = std::make_unique<SceneLibraries>(m_files);
    }
    MaterialId find(const char* name) { return m_libraries->materials.find(name, lightmapContext::kByVertex); }
};

TEST_F(LightAnimationTest, OnlyWhatChangesIsAnimated) {
    LightAnimation animation(m_libraries->materials, m_libraries->textures);
    EXPECT_EQ(animation.find(find("textures/steady")), 0u) << "what scrolls keeps its mean";
    EXPECT_EQ(animation.find(find("textures/blinking")), 1u);
    EXPECT_EQ(animation.find(find("textures/lamp")), 2u);
    EXPECT_EQ(animation.find(find("textures/blinking")), 1u);
}

TEST_F(LightAnimationTest, FollowsTheGlowWithMeanOne) {
    LightAnimation animation(m_libraries->materials, m_libraries->textures);
    for (const char* name : {"textures/blinking", "textures/lamp", "textures/pictures"})
        animation.find(find(name));
    const std::vector<vec3> early = animation.evaluate(0.125), late = animation.evaluate(0.625);
    EXPECT_NEAR(early[0].r, 2, 0.05f) << "on half of the time";
    EXPECT_EQ(late[0].r, 0);
    EXPECT_EQ(early[0].g, 1) << "a channel that never glows stays as baked";
    EXPECT_NEAR(early[1].g, 1.5f, 0.02f) << "the lit stages are no glow";
    EXPECT_NEAR(animation.evaluate(0.375)[1].g, 0.5f, 0.02f);
    EXPECT_NEAR(animation.evaluate(0.05)[2].r, 2, 0.05f);
    EXPECT_NEAR(animation.evaluate(0.15)[2].g, 2, 0.05f);
    glm::dvec3 mean(0);
    for (int i = 0; i < 1000; ++i)
        mean += glm::dvec3(animation.evaluate(i * 0.01)[1]) / 1000.0;
    EXPECT_NEAR(mean.g, 1, 0.01);
}

} // namespace
} // namespace q3rt::test
