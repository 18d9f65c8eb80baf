// Models, skins, tags, levels of detail (spec of models 1 to 3).

#include <gtest/gtest.h>

#include "md3_builder.hpp"
#include "scene/model.hpp"
#include "scene_fixture.hpp"

namespace q3rt::test {
namespace {

Orientation makeTag(const vec3& origin, const vec3& forward, const vec3& left) {
    return {origin, {forward, left, glm::cross(forward, left)}};
}

class ModelTest : public testing::Test {
  protected:
    MemoryFiles m_files;
    std::unique_ptr<SceneLibraries> m_libraries;
    std::unique_ptr<ModelLibrary> m_models;

    void SetUp() override {
        m_files.addText("scripts/a.shader", "skin/red { { map $whiteimage } }\nskin/blue { { map $whiteimage } }\n");
        Md3TestFrame first, second;
        first.tags = {{"tag_head", makeTag({0, 0, 10}, {1, 0, 0}, {0, 1, 0})}};
        second.tags = {{"tag_head", makeTag({0, 8, 10}, {0, 1, 0}, {-1, 0, 0})}};
        second.height = 4;
        m_files.files["models/a.md3"] = buildMd3({first, second}, "skin/red");
        m_files.files["models/b.md3"] = buildMd3({first}, "skin/red");
        m_files.files["models/b_1.md3"] = buildMd3({first}, "skin/red");
        m_files.files["models/b_2.md3"] = buildMd3({first}, "skin/red");
        m_files.files["models/old.mdr"] = std::vector<std::byte>(16);
        m_files.addText("models/a.skin", "body,skin/blue\ntag_head,\n");
        m_files.addText("models/other.skin", "legs,skin/blue\n");
        m_libraries = std::make_unique<SceneLibraries>(m_files);
        m_models = std::make_unique<ModelLibrary>(m_files, m_libraries->materials);
    }

    MaterialId material(const char* name) { return m_libraries->materials.find(name, lightmapContext::kNone); }
};

TEST_F(ModelTest, NamesAreExactAndFailuresRemembered) {
    const int a = m_models->registerModel("models/a.md3");
    EXPECT_GT(a, 0);
    EXPECT_EQ(m_models->registerModel("models/a.md3"), a);
    EXPECT_NE(m_models->registerModel("models/a"), a) << "another name is another model";
    EXPECT_EQ(m_models->registerModel("models/nothing.md3"), 0);
    EXPECT_EQ(m_models->registerModel(""), 0);
    EXPECT_EQ(m_models->registerModel(std::string(64, 'x')), 0);
    EXPECT_EQ(m_models->get(12345).kind, Model::Kind::Bad);
}

TEST_F(ModelTest, DamagedFilesAreReportedByName) {
    const LogCapture log;
    EXPECT_EQ(m_models->registerModel("models/old.mdr"), 0);
    EXPECT_EQ(log.count("models/old.mdr: is no MDR model"), 1u);
}

TEST_F(ModelTest, TagsBlendAndAreNormalised) {
    const int a = m_models->registerModel("models/a.md3");
    Orientation tag;
    ASSERT_TRUE(m_models->lerpTag(a, 0, 1, 0.25f, "tag_head", tag));
    EXPECT_NEAR(tag.axis[0].x, 0.9487f, 1e-4f);
    EXPECT_NEAR(tag.axis[0].y, 0.3162f, 1e-4f);
    EXPECT_EQ(tag.origin, vec3(0, 2, 10));
    ASSERT_TRUE(m_models->lerpTag(a, 99, 99, 0, "tag_head", tag)) << "beyond the end: the last frame";
    EXPECT_EQ(tag.origin, vec3(0, 8, 10));
    ASSERT_TRUE(m_models->lerpTag(a, -5, 0, 0, "tag_head", tag));
    EXPECT_FALSE(m_models->lerpTag(a, 0, 1, 0.25f, "TAG_HEAD", tag)) << "case matters";
    EXPECT_EQ(tag.origin, vec3(0));
    EXPECT_EQ(tag.axis[1], vec3(0, 1, 0));
    EXPECT_FALSE(m_models->lerpTag(0, 0, 1, 0.25f, "tag_head", tag));
}

TEST_F(ModelTest, MaterialIsTheCustomOneThenTheSkinsThenItsOwn) {
    const int a = m_models->registerModel("models/a.md3");
    const ModelSurface& surface = m_models->get(a).lods[0].surfaces[0];
    const int skin = m_models->registerSkin("models/a.skin"), other = m_models->registerSkin("models/other.skin");
    const auto red = material("skin/red"), blue = material("skin/blue");
    EXPECT_EQ(m_models->registerSkin("MODELS/A.skin"), skin);
    EXPECT_EQ(surfaceMaterial(*m_models, surface, 0, 0, 0), red);
    EXPECT_EQ(surfaceMaterial(*m_models, surface, 0, skin, 0), blue);
    EXPECT_EQ(surfaceMaterial(*m_models, surface, 0, other, 0), 0u) << "unmatched surfaces show the default look";
    EXPECT_EQ(surfaceMaterial(*m_models, surface, 0, 9999, 0), red) << "no such skin: ignored";
    EXPECT_EQ(surfaceMaterial(*m_models, surface, static_cast<int>(blue), other, 0), blue);
    EXPECT_EQ(surfaceMaterial(*m_models, surface, 99999, 0, 0), 0u);
    EXPECT_EQ(surfaceMaterial(*m_models, surface, 0, 0, -7), red) << "negative skin numbers wrap";
    EXPECT_EQ(m_models->registerSkin("models/none.skin"), 0);
    EXPECT_GT(m_models->registerSkin("skin/blue"), 0) << "a plain shader is a skin that matches nothing";
}

TEST_F(ModelTest, LevelsComeFromNumberedFiles) {
    EXPECT_EQ(m_models->get(m_models->registerModel("models/b.md3")).lods.size(), 3u);
    EXPECT_EQ(m_models->get(m_models->registerModel("models/a.md3")).lods.size(), 1u);
}

TEST_F(ModelTest, BoundsAreThoseOfFrameZero) {
    const Bounds box = m_models->modelBounds(m_models->registerModel("models/a.md3"), nullptr);
    EXPECT_EQ(box.mins, vec3(-8));
    EXPECT_EQ(box.maxs, vec3(8));
    EXPECT_EQ(m_models->modelBounds(0, nullptr).maxs, vec3(0));
}

/// Distance at which 1 - 5 r / (d tan(fov/2)) = f, for a 90 degree view.
float distanceOf(float radius, float f) { return 5 * radius / (1 - f); }

TEST(ModelLod, SwitchesAtThirdsAndHalves) {
    int count = 3;
    const Bounds box{vec3(-3, -4, 0), vec3(3, 4, 12)};
    const float radius = 13;
    const auto lodAt = [&](float distance, int bias = 0) {
        return chooseLod(count, box, vec3(distance, 0, 0), Orientation{}, glm::radians(90.0f), 5, bias);
    };
    EXPECT_EQ(lodAt(-10), 0) << "behind the eye";
    EXPECT_EQ(lodAt(distanceOf(radius, 0.32f)), 0);
    EXPECT_EQ(lodAt(distanceOf(radius, 0.35f)), 1);
    EXPECT_EQ(lodAt(distanceOf(radius, 0.65f)), 1);
    EXPECT_EQ(lodAt(distanceOf(radius, 0.68f)), 2);
    EXPECT_EQ(lodAt(distanceOf(radius, 0.68f), 5), 2);
    EXPECT_EQ(lodAt(10, -3), 0);
    count = 2;
    EXPECT_EQ(lodAt(distanceOf(radius, 0.49f)), 0);
    EXPECT_EQ(lodAt(distanceOf(radius, 0.51f)), 1);
    count = 1;
    EXPECT_EQ(lodAt(100000), 0);
}

TEST(ModelFrames, BadOnesResetBothAndWrapKeepsTheSign) {
    const auto resolve = [](bool wrap, int frame, int oldFrame) {
        resolveFrames(2, wrap, frame, oldFrame);
        return std::pair(frame, oldFrame);
    };
    EXPECT_EQ(resolve(false, 1, 0), std::pair(1, 0));
    EXPECT_EQ(resolve(false, 2, 0), std::pair(0, 0));
    EXPECT_EQ(resolve(false, 1, 5), std::pair(0, 0));
    EXPECT_EQ(resolve(false, -1, 1), std::pair(0, 0));
    EXPECT_EQ(resolve(true, 3, 4), std::pair(1, 0));
    EXPECT_EQ(resolve(true, -1, 1), std::pair(0, 0));
}

} // namespace
} // namespace q3rt::test
