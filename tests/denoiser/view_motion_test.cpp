// Which frames continue each other, and which entities are found again.

#include <gtest/gtest.h>
#include <set>

#include <glm/gtc/matrix_transform.hpp>

#include "renderer_rt/view_motion.hpp"

namespace q3rt {
namespace {

EntityPlace modelAt(int model, const vec3& origin) {
    EntityPlace place;
    place.model = model;
    place.anchor = origin;
    place.worldFromModel = glm::translate(mat4(1.0f), origin);
    return place;
}

/// Each entity shows one instance; those of `shaped` change their shape.
ViewInstant instant(uint32_t picture, const vec3& eye, std::vector<EntityPlace> entities = {},
                    const std::set<int>& shaped = {}) {
    ViewInstant out;
    out.camera.eye = eye;
    out.timeMs = static_cast<int>(picture) * 16;
    out.pictureNumber = picture;
    out.sampleFrame = picture;
    EntityPlace world;
    world.moves = false;
    out.entities.push_back(world);
    out.entities.insert(out.entities.end(), entities.begin(), entities.end());
    for (uint32_t e = 0; e < out.entities.size(); ++e) {
        InstancePlace& place = out.instances.emplace_back();
        place.entity = e;
        place.changesShape = shaped.contains(out.entities[e].model);
        place.firstCorner = 10 * e;
        out.indexAddress.push_back(1000 + e);
    }
    return out;
}

vec3 apply(const RtMotion& motion, const vec3& p) {
    vec3 out;
    for (int i = 0; i < 3; ++i)
        out[i] = glm::dot(motion.rows[i], vec4(p, 1));
    return out;
}

TEST(ViewMotion, JumpsBreakTheHistory) {
    ViewMotion motion;
    motion.advance(instant(1, {0, 0, 0}));
    EXPECT_FALSE(motion.isContinuous()) << "nothing before";
    motion.advance(instant(2, {10, 0, 0}));
    EXPECT_TRUE(motion.isContinuous());
    motion.advance(instant(3, {1000, 0, 0}));
    EXPECT_FALSE(motion.isContinuous()) << "teleported";
    motion.advance(instant(5, {1000, 0, 0}));
    EXPECT_FALSE(motion.isContinuous()) << "a picture without this view";
    ViewInstant back = instant(6, {1000, 0, 0});
    back.timeMs = 0;
    motion.advance(back);
    EXPECT_FALSE(motion.isContinuous()) << "the clock went back";
    ViewInstant changed = instant(7, {1000, 0, 0});
    changed.settingsKey = {1};
    motion.advance(changed);
    EXPECT_FALSE(motion.isContinuous()) << "another kind of light";
}

TEST(ViewMotion, FindsEntitiesAgain) {
    ViewMotion motion;
    motion.advance(instant(1, {0, 0, 0}, {modelAt(7, {0, 0, 0}), modelAt(7, {100, 0, 0}), modelAt(9, {50, 0, 0})}));
    // In another order; one has moved, one is new.
    motion.advance(instant(2, {0, 0, 0}, {modelAt(8, {50, 0, 0}), modelAt(7, {104, 0, 2}), modelAt(7, {0, 0, 0})}));
    const std::vector<RtMotion> toPrevious = motion.toPrevious(0), toCurrent = motion.toCurrent(0);
    ASSERT_EQ(toPrevious.size(), 4u);
    EXPECT_EQ(toPrevious[0].kind, kMotionNone) << "the world";
    EXPECT_EQ(toPrevious[1].kind, kMotionUnknown) << "another model";
    EXPECT_EQ(toPrevious[2].kind, kMotionRigid);
    EXPECT_EQ(toPrevious[3].kind, kMotionNone);
    EXPECT_LT(glm::distance(apply(toPrevious[2], {105, 1, 2}), vec3(101, 1, 0)), 1e-4f);
    EXPECT_EQ(toCurrent[1].kind, kMotionNone);
    EXPECT_EQ(toCurrent[2].kind, kMotionRigid);
    EXPECT_EQ(toCurrent[3].kind, kMotionUnknown);
    EXPECT_LT(glm::distance(apply(toCurrent[2], {101, 1, 0}), vec3(105, 1, 2)), 1e-4f);
}

TEST(ViewMotion, ShapesFollowTheirCorners) {
    ViewMotion motion;
    motion.advance(instant(1, {0, 0, 0}, {modelAt(5, {0, 0, 0}), modelAt(3, {8, 0, 0})}, {3}));
    motion.advance(instant(2, {0, 0, 0}, {modelAt(3, {9, 0, 0})}, {3}));
    const RtMotion back = motion.toPrevious(4096)[1], forth = motion.toCurrent(8192)[2];
    EXPECT_EQ(back.kind, kMotionShape);
    EXPECT_EQ(back.corners, 4096 + 20 * sizeof(vec3)) << "of the frame before";
    EXPECT_EQ(back.indices, 1001u) << "triangles of this frame";
    EXPECT_EQ(back.shapeRows[0].w, 8);
    EXPECT_EQ(forth.kind, kMotionShape);
    EXPECT_EQ(forth.corners, 8192 + 10 * sizeof(vec3));
    EXPECT_EQ(forth.indices, 1001u);
    EXPECT_EQ(forth.shapeRows[0].w, 9);
}

TEST(ViewMotion, AShapeWithOtherCornersIsUnknown) {
    ViewMotion motion;
    ViewInstant before = instant(1, {0, 0, 0}, {modelAt(3, {0, 0, 0}), modelAt(4, {0, 0, 0})}, {3, 4});
    ViewInstant after = instant(2, {0, 0, 0}, {modelAt(3, {0, 0, 0}), modelAt(4, {0, 0, 0})}, {3, 4});
    before.instances[1].key = 77; // another level of detail
    after.instances[2].keepsOrder = false;
    motion.advance(std::move(before));
    motion.advance(std::move(after));
    EXPECT_EQ(motion.toPrevious(0)[1].kind, kMotionUnknown);
    EXPECT_EQ(motion.toPrevious(0)[2].kind, kMotionShape);
    EXPECT_EQ(motion.toCurrent(0)[2].kind, kMotionUnknown) << "triangles have other numbers";
}

TEST(EntityMatching, FollowsAStreamOfMissiles) {
    // One every 100 ms at 2,000 qu/s: 200 qu apart, and in a frame of 100 ms each is where the one before it was.
    std::vector<EntityPlace> before, now;
    for (int i = 0; i < 5; ++i) {
        EntityPlace missile = modelAt(2, {i * 200.0f, 0, 0});
        missile.velocity = {2, 0, 0};
        before.push_back(missile);
    }
    for (int i = 5; i >= 0; --i) // the newest comes last: nobody's
        now.push_back(modelAt(2, {i * 200.0f, 0, 0}));
    const auto found = matchEntities(now, before, 100);
    for (size_t i = 0; i < 5; ++i)
        EXPECT_EQ(found[i], 4 - i);
    EXPECT_FALSE(found[5]);
}

TEST(EntityMatching, TellsKindsApartAndKnowsJumps) {
    EntityPlace red = modelAt(2, {0, 0, 0}), blue = red, far = modelAt(3, {0, 0, 0}), gone = far, early = red,
                late = red;
    blue.skin = 4;
    far.anchor = {1000, 0, 0};
    early.kind = late.kind = EntityKind::Sprite;
    late.startSeconds = 0.25f;
    const auto found = matchEntities({red, blue, far, late}, {blue, red, gone, early}, 16);
    EXPECT_EQ(found[0], 1u);
    EXPECT_EQ(found[1], 0u);
    EXPECT_FALSE(found[2]) << "teleported";
    EXPECT_FALSE(found[3]) << "another explosion";
}

} // namespace
} // namespace q3rt
