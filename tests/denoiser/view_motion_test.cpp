// Which frames continue each other, and which entities are found again.

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "renderer_rt/view_motion.hpp"

namespace q3rt {
namespace {

EntityPlace modelAt(int model, const vec3& origin, int frame = 0) {
    EntityPlace place;
    place.rigid = true;
    place.model = model;
    place.frame = place.oldFrame = frame;
    place.worldFromModel = glm::translate(mat4(1.0f), origin);
    return place;
}

ViewInstant instant(uint32_t picture, const vec3& eye, std::vector<EntityPlace> entities = {}) {
    ViewInstant out;
    out.camera.eye = eye;
    out.timeMs = static_cast<int>(picture) * 16;
    out.pictureNumber = picture;
    out.sampleFrame = picture;
    EntityPlace world;
    world.moves = false;
    out.entities.push_back(world);
    out.entities.insert(out.entities.end(), entities.begin(), entities.end());
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
    motion.advance(instant(1, {0, 0, 0}, {modelAt(7, {0, 0, 0}), modelAt(7, {100, 0, 0}), modelAt(9, {50, 0, 0}, 3)}));
    // In another order; one has moved, one shows another frame of its animation.
    motion.advance(instant(2, {0, 0, 0}, {modelAt(9, {50, 0, 0}, 4), modelAt(7, {104, 0, 2}), modelAt(7, {0, 0, 0})}));
    ASSERT_EQ(motion.toPrevious().size(), 4u);
    EXPECT_EQ(motion.toPrevious()[0].kind, kMotionNone) << "the world";
    EXPECT_EQ(motion.toPrevious()[1].kind, kMotionUnknown) << "animated";
    EXPECT_EQ(motion.toPrevious()[2].kind, kMotionRigid);
    EXPECT_EQ(motion.toPrevious()[3].kind, kMotionNone);
    EXPECT_LT(glm::distance(apply(motion.toPrevious()[2], {105, 1, 2}), vec3(101, 1, 0)), 1e-4f);
    EXPECT_EQ(motion.toCurrent()[1].kind, kMotionNone);
    EXPECT_EQ(motion.toCurrent()[2].kind, kMotionRigid);
    EXPECT_EQ(motion.toCurrent()[3].kind, kMotionUnknown);
    EXPECT_LT(glm::distance(apply(motion.toCurrent()[2], {101, 1, 0}), vec3(105, 1, 2)), 1e-4f);
}

TEST(ViewMotion, DeformedAndNewEntitiesAreUnknown) {
    ViewMotion motion;
    EntityPlace flag = modelAt(3, {0, 0, 0});
    flag.rigid = false;
    motion.advance(instant(1, {0, 0, 0}, {flag}));
    motion.advance(instant(2, {0, 0, 0}, {flag, modelAt(4, {0, 0, 0})}));
    EXPECT_EQ(motion.toPrevious()[1].kind, kMotionUnknown);
    EXPECT_EQ(motion.toPrevious()[2].kind, kMotionUnknown);
}

} // namespace
} // namespace q3rt
