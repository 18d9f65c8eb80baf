// MDR and IQM files: what is read, and that damage is refused.

#include <limits>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "formats/iqm.hpp"
#include "formats/mdr.hpp"
#include "support/bone_models.hpp"
#include "support/tiny_files.hpp"

namespace q3rt {
namespace {

using Parser = void (*)(const std::vector<std::byte>&);

std::string errorOf(Parser parse, const std::vector<std::byte>& file) {
    try {
        parse(file);
    } catch (const ContentError& error) {
        return error.what();
    }
    return "";
}
void asMdr(const std::vector<std::byte>& file) { parseMdr(file, "models/bar.mdr"); }
void asIqm(const std::vector<std::byte>& file) { parseIqm(file, "models/bar.iqm"); }

TEST(Mdr, ReadsFramesBonesLevelsAndTags) {
    test::BarOptions options;
    options.lods = 2;
    const Mdr model = parseMdr(test::makeBarMdr(options), "t");
    ASSERT_EQ(model.frames.size(), 3u);
    EXPECT_EQ(model.frames[1].localOrigin, vec3(16, 0, 0));
    ASSERT_EQ(model.boneCount, 2u);
    EXPECT_EQ(model.bones[1].column(3), vec3(16, 0, 0));
    EXPECT_NEAR(model.bones[2 * 2 + 1].column(0).z, 1, 1e-6) << "frame 2: the tip points up";
    ASSERT_EQ(model.lods.size(), 2u);
    ASSERT_EQ(model.lods[0].size(), 1u);
    const MdrSurface& surface = model.lods[0][0];
    EXPECT_EQ(surface.name, "bar");
    EXPECT_EQ(surface.shader, "models/bar");
    EXPECT_EQ(surface.vertices.size(), 12u);
    EXPECT_EQ(surface.indices.size(), 48u);
    EXPECT_EQ(surface.vertices[4].weightCount, 2u) << "the middle ring";
    EXPECT_EQ(surface.weights[surface.vertices[8].firstWeight].offset, vec3(16, -4, -4));
    ASSERT_EQ(model.tags.size(), 2u);
    EXPECT_EQ(model.tags[1].name, "tip");
    EXPECT_EQ(model.tags[1].bone, 1u);
}

TEST(Mdr, CompressedBonesAreThePlainOnesInSteps) {
    test::BarOptions options;
    const Mdr plain = parseMdr(test::makeBarMdr(options), "t");
    options.compressed = true;
    const Mdr compressed = parseMdr(test::makeBarMdr(options), "t");
    ASSERT_EQ(compressed.bones.size(), plain.bones.size());
    for (size_t i = 0; i < plain.bones.size(); ++i)
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column) {
                // Half a step of 1/64 qu, or of 1/32766.
                const float bound = column == 3 ? 0.5f / 64 : 0.5f / 32766;
                EXPECT_NEAR(compressed.bones[i].row[row][column], plain.bones[i].row[row][column], bound + 1e-7f);
            }
}

TEST(Iqm, ReadsMeshesSkeletonAndFrames) {
    test::BarOptions options;
    options.colors = true;
    const Iqm model = parseIqm(test::makeBarIqm(options), "t");
    ASSERT_EQ(model.meshes.size(), 1u);
    EXPECT_EQ(model.meshes[0].name, "bar");
    EXPECT_EQ(model.meshes[0].material, "models/bar");
    EXPECT_EQ(model.meshes[0].indices.size(), 48u);
    EXPECT_EQ(model.positions[8], vec3(32, -4, -4));
    EXPECT_EQ(model.colors[8][2], 255);
    ASSERT_EQ(model.joints.size(), 2u);
    EXPECT_EQ(model.joints[1].name, "tip");
    EXPECT_EQ(model.joints[1].parent, 0);
    EXPECT_EQ(model.blendWeights[0], vec4(1, 0, 0, 0));
    EXPECT_NEAR(model.blendWeights[4].x, 128.0f / 255, 1e-7f);
    ASSERT_EQ(model.frameCount, 3u);
    ASSERT_EQ(model.bounds.size(), 3u);
    const IqmTransform bent = model.poseAt(2, 1);
    EXPECT_EQ(bent.translate, vec3(16, 0, 0));
    EXPECT_NEAR(bent.rotate.y, -std::sin(0.785398f), 1e-4f);
    EXPECT_NEAR(bent.rotate.w, std::cos(0.785398f), 1e-4f);
}

TEST(Iqm, RestsWithoutASkeleton) {
    test::BarOptions options;
    options.skeleton = false;
    const Iqm model = parseIqm(test::makeBarIqm(options), "t");
    EXPECT_TRUE(model.joints.empty() && model.poses.empty() && model.blendIndexes.empty());
    EXPECT_EQ(model.frameCount, 0u);
}

TEST(BoneModels, EveryTruncationIsRefused) {
    for (const auto& [parse, whole] :
         {std::pair<Parser, std::vector<std::byte>>{asMdr, test::makeBarMdr()}, {asIqm, test::makeBarIqm()}})
        for (size_t length = 0; length + 36 < whole.size(); length += 3)
            EXPECT_TRUE(
                errorOf(parse, {whole.begin(), whole.begin() + static_cast<long>(length)}).starts_with("models/bar."))
                << length;
}

TEST(BoneModels, DamageIsRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto damaged = [](std::vector<std::byte> file, size_t offset, auto value) {
        test::overwrite(file, offset, value);
        return file;
    };
    const std::vector<std::byte> mdr = test::makeBarMdr(), iqm = test::makeBarIqm();
    EXPECT_NE(errorOf(asMdr, damaged(mdr, 4, 3)).find("version 3"), std::string::npos);
    EXPECT_NE(errorOf(asMdr, damaged(mdr, 72, 0)).find("no frames"), std::string::npos);
    EXPECT_NE(errorOf(asMdr, damaged(mdr, 76, 1)).find("bone"), std::string::npos) << "weights name a second one";
    EXPECT_NE(errorOf(asMdr, damaged(mdr, 76, 0x40000000)).find("frames lie outside"), std::string::npos);
    EXPECT_NE(errorOf(asMdr, damaged(mdr, 104, nan)).find("not finite"), std::string::npos);
    EXPECT_NE(errorOf(asMdr, damaged(mdr, mdr.size() - 36, 7)).find("tag 'tip'"), std::string::npos);
    EXPECT_NE(errorOf(asIqm, damaged(iqm, 16, 1)).find("version 1"), std::string::npos);
    EXPECT_NE(errorOf(asIqm, damaged(iqm, 20, int32_t(iqm.size() + 1))).find("too early"), std::string::npos);
    EXPECT_NE(errorOf(asIqm, damaged(iqm, 76, 1)).find("number of poses"), std::string::npos);
    EXPECT_NE(errorOf(asIqm, damaged(iqm, 96, 1)).find("channels"), std::string::npos);
    EXPECT_NE(errorOf(asIqm, damaged(iqm, 92, 0x7fffffff)).find("frames lie outside"), std::string::npos);
}

} // namespace
} // namespace q3rt
