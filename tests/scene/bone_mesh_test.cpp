// Models with bones: vertices and tags of any two frames (spec of models 2.3 and 3).

#include <cmath>

#include <gtest/gtest.h>

#include "scene/model.hpp"
#include "scene_fixture.hpp"
#include "support/bone_models.hpp"

namespace q3rt::test {
namespace {

constexpr float kTolerance = 2e-3f; // the IQM's quaternions come in steps of 3e-5, over a bar of 32 qu
constexpr size_t kTipCorner = 8;    // of the outer ring
constexpr float kDegree = 0.0174532925f;

class BoneMeshTest : public testing::Test {
  protected:
    MemoryFiles m_files;
    std::unique_ptr<SceneLibraries> m_libraries;
    std::unique_ptr<ModelLibrary> m_models;

    void SetUp() override {
        m_files.addText("scripts/a.shader", "models/bar { { map $whiteimage } }\n");
        BarOptions options;
        m_files.files["models/bar.iqm"] = makeBarIqm(options);
        options.lods = 2;
        m_files.files["models/bar.mdr"] = makeBarMdr(options);
        options.skeleton = false;
        options.colors = true;
        m_files.files["models/rigid.iqm"] = makeBarIqm(options);
        m_libraries = std::make_unique<SceneLibraries>(m_files);
        m_models = std::make_unique<ModelLibrary>(m_files, m_libraries->materials);
    }

    const Model& model(const char* name) { return m_models->get(m_models->registerModel(name)); }

    static std::vector<Vertex> verticesAt(const Model& model, const FramePair& frames) {
        std::vector<Affine> bones;
        std::vector<Vertex> vertices;
        model.lods[0].mesh->pose(frames, bones);
        model.lods[0].mesh->appendVertices(0, frames, bones, vertices);
        return vertices;
    }
    /// Of the four corners of the outer ring, bent by an angle.
    static vec3 tipAt(float degrees) {
        return vec3(16 + 16 * std::cos(degrees * kDegree), 0, 16 * std::sin(degrees * kDegree));
    }
    static vec3 middleOfTip(const std::vector<Vertex>& vertices) {
        vec3 sum(0.0f);
        for (size_t i = 0; i < 4; ++i)
            sum += vertices[kTipCorner + i].position;
        return sum * 0.25f;
    }
};

TEST_F(BoneMeshTest, BothFormatsBendAlike) {
    for (const char* name : {"models/bar.mdr", "models/bar.iqm"}) {
        const Model& bar = model(name);
        ASSERT_EQ(bar.kind, Model::Kind::Mesh) << name;
        for (int frame = 0; frame < 3; ++frame) {
            const std::vector<Vertex> vertices = verticesAt(bar, {frame, frame, 0});
            ASSERT_EQ(vertices.size(), 12u);
            EXPECT_NEAR(glm::distance(middleOfTip(vertices), tipAt(45.0f * static_cast<float>(frame))), 0, kTolerance)
                << name << " frame " << frame;
            EXPECT_NEAR(glm::length(vertices[kTipCorner].normal), 1, 1e-3f);
        }
    }
}

TEST_F(BoneMeshTest, MatricesBlendByElementAndQuaternionsOnTheArc) {
    // Half of a quarter turn: the blended matrices halve the bar's outer part to cos 45, the arc keeps its length.
    const FramePair half{2, 0, 0.5f};
    const vec3 blended = middleOfTip(verticesAt(model("models/bar.mdr"), half));
    EXPECT_NEAR(glm::distance(blended, (tipAt(0) + tipAt(90)) * 0.5f), 0, kTolerance);
    const vec3 turned = middleOfTip(verticesAt(model("models/bar.iqm"), {2, 0, 0.75f}));
    EXPECT_NEAR(glm::distance(turned, tipAt(22.5f)), 0, kTolerance) << "a quarter of the way from the old frame";
}

TEST_F(BoneMeshTest, TagsAreBones) {
    for (const char* name : {"models/bar.mdr", "models/bar.iqm"}) {
        const int handle = m_models->registerModel(name);
        Orientation tag;
        ASSERT_TRUE(m_models->lerpTag(handle, 0, 2, 1, "tip", tag)) << name;
        EXPECT_NEAR(glm::distance(tag.origin, vec3(16, 0, 0)), 0, kTolerance);
        EXPECT_NEAR(glm::distance(tag.axis[0], vec3(0, 0, 1)), 0, kTolerance);
        EXPECT_NEAR(glm::distance(tag.axis[2], vec3(-1, 0, 0)), 0, kTolerance);
        ASSERT_TRUE(m_models->lerpTag(handle, 99, 99, 0, "tip", tag)) << "beyond the end: the last frame";
        EXPECT_NEAR(tag.axis[0].z, 1, kTolerance);
        EXPECT_FALSE(m_models->lerpTag(handle, 0, 0, 0, "Tip", tag));
    }
}

TEST_F(BoneMeshTest, LevelsBoundsAndColours) {
    EXPECT_EQ(model("models/bar.mdr").lods.size(), 2u);
    EXPECT_EQ(model("models/bar.iqm").lods.size(), 1u);
    EXPECT_EQ(m_models->modelBounds(m_models->registerModel("models/bar.mdr"), nullptr).maxs, vec3(40));
    const Model& rigid = model("models/rigid.iqm");
    EXPECT_EQ(rigid.lods[0].mesh->frameCount(), 1u);
    EXPECT_EQ(m_models->modelBounds(m_models->registerModel("models/rigid.iqm"), nullptr).maxs, vec3(32, 4, 4))
        << "of all vertices where there are no frames";
    const std::vector<Vertex> vertices = verticesAt(rigid, {});
    EXPECT_EQ(vertices[0].color, 0xff0000ffu);
    EXPECT_EQ(vertices[kTipCorner].color, 0xffff0000u);
    EXPECT_EQ(verticesAt(model("models/bar.iqm"), {})[0].color, 0u) << "no colours in the file";
}

} // namespace
} // namespace q3rt::test
