// A node's boxes are what was put in, and no ray that meets a box in exact arithmetic passes it by.

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "accel/bvh_node.hpp"

namespace q3rt::shader {
namespace {
using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;
#include "lib/intersect.glsl"
} // namespace
} // namespace q3rt::shader

namespace q3rt {
namespace {

/// 113 bits: sums and products of the numbers here (24 bits, exponents within 80 of each other) are exact.
__extension__ using Exact = __float128;

using Random = std::mt19937;

float uniform(Random& random, float low, float high) {
    return low + (high - low) * (static_cast<float>(random() >> 8) * 0x1p-24f);
}

struct Interval {
    float low, high;
};

Box4 boxOf(const std::array<Interval, 3>& axes) {
    return Box4(Bounds{{axes[0].low, axes[1].low, axes[2].low}, {axes[0].high, axes[1].high, axes[2].high}});
}

/// Four boxes from intervals a child and axis.
BvhNode makeNode(const std::array<std::array<Interval, 3>, 4>& children) {
    NodeContent content;
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        content.box[slot] = boxOf(children[slot]);
        content.groups[slot] = kBvhSolidGroup;
        content.child[slot] = leafWord(slot, 1);
    }
    return packNode(content);
}

TEST(BvhNode, HoldsTheBoxesThatWerePutIn) {
    Random random(11);
    for (int i = 0; i < 1000; ++i) {
        std::array<std::array<Interval, 3>, 4> children;
        for (auto& child : children)
            for (Interval& interval : child) {
                const float centre = std::ldexp(uniform(random, -2, 2), static_cast<int>(random() % 76) - 38);
                interval = {centre, centre + std::abs(centre) * uniform(random, 0, 2)};
            }
        const BvhNode node = makeNode(children);
        for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
            const Bounds box = childBounds(node, slot);
            for (size_t axis = 0; axis < 3; ++axis) {
                ASSERT_EQ(box.mins[static_cast<int>(axis)], children[slot][axis].low);
                ASSERT_EQ(box.maxs[static_cast<int>(axis)], children[slot][axis].high);
            }
        }
    }
}

/// Where the ray enters or leaves on an axis.
glm::vec4 planeOf(const BvhNode& node, const shader::SlabRay& ray, int axis, bool leaves) {
    const bool back = ray.reciprocal[axis] < 0;
    return node.bounds[axis + (back != leaves ? static_cast<int>(kBvhToHigh) : 0)];
}

Bounds wholeOf(const std::array<std::array<Interval, 3>, 4>& children) {
    Bounds whole;
    for (const auto& child : children) {
        const Box4 box = boxOf(child);
        whole.add(box.low());
        whole.add(box.high());
    }
    return whole;
}

/// Does the ray meet the box in [tMin, tMax]? `direction` as slab tests take it.
bool meetsExactly(const Box4& box, const vec3& origin, const vec3& direction, float tMin, float tMax) {
    Exact near = tMin, far = tMax;
    for (int axis = 0; axis < 3; ++axis) {
        const Exact a = (Exact(box.mins[axis]) - Exact(origin[axis])) / Exact(direction[axis]);
        const Exact b = (Exact(box.maxs[axis]) - Exact(origin[axis])) / Exact(direction[axis]);
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

/// A point of the box: inside, or on one of its faces, edges or corners.
vec3 pointOf(Random& random, const Box4& box) {
    vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
        const uint32_t where = random() % 4;
        p[axis] = where == 0   ? box.mins[axis]
                  : where == 1 ? box.maxs[axis]
                               : uniform(random, box.mins[axis], box.maxs[axis]);
    }
    return p;
}

TEST(BvhNode, NoBoxThatARayMeetsIsPassedBy) {
    Random random(12);
    size_t met = 0, more = 0, rays = 0;
    for (int i = 0; i < 20000; ++i) {
        std::array<std::array<Interval, 3>, 4> children;
        const float place = i % 3 == 0 ? 0.0f : i % 3 == 1 ? 4096.0f : 65536.0f;
        for (auto& child : children)
            for (Interval& interval : child) {
                const float centre = place + std::round(uniform(random, -512, 512));
                const float size = random() % 4 == 0 ? 0.0f : uniform(random, 0, 300);
                interval = {centre, centre + size};
            }
        const BvhNode node = makeNode(children);
        for (int k = 0; k < 20; ++k, ++rays) {
            const vec3 target = pointOf(random, boxOf(children[random() % 4]));
            const vec3 origin = random() % 4 == 0 ? pointOf(random, boxOf(children[random() % 4]))
                                                  : target + vec3(uniform(random, -1, 1), uniform(random, -1, 1),
                                                                  uniform(random, -1, 1)) *
                                                                 std::exp2(uniform(random, -10, 13));
            vec3 direction = target - origin;
            for (int axis = 0; axis < 3; ++axis)
                if (random() % 8 == 0) direction[axis] = 0;
            const float tMax = random() % 2 ? 1.0f : 3e38f, tMin = random() % 4 == 0 ? 0.5f : 0.0f;
            // A device may miss the quotient by 2.5 units in the last place.
            vec3 reciprocal = shader::slabReciprocal(direction);
            vec3 exactDirection;
            for (int axis = 0; axis < 3; ++axis) {
                exactDirection[axis] = std::abs(direction[axis]) < 0x1p-80f ? 0x1p-80f : direction[axis];
                for (uint32_t step = random() % 3; step > 0; --step)
                    reciprocal[axis] = std::nextafter(reciprocal[axis], random() % 2 ? 3e38f : -3e38f);
            }
            uint32_t first = 0;
            const shader::SlabRay ray = shader::makeSlabRay(origin, reciprocal, reachOf(wholeOf(children)));
            const uint32_t bits =
                shader::boxesMet(planeOf(node, ray, 0, false), planeOf(node, ray, 1, false),
                                 planeOf(node, ray, 2, false), planeOf(node, ray, 0, true), planeOf(node, ray, 1, true),
                                 planeOf(node, ray, 2, true), ray, tMin, tMax, first);
            for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
                const bool exactly = meetsExactly(boxOf(children[slot]), origin, exactDirection, tMin, tMax);
                const bool found = (bits >> slot & 1u) != 0;
                ASSERT_TRUE(found || !exactly) << "node " << i << " ray " << k << " child " << slot;
                met += exactly ? 1 : 0;
                more += found && !exactly ? 1 : 0;
            }
            ASSERT_TRUE(bits == 0 || (bits >> first & 1u) != 0);
        }
    }
    EXPECT_EQ(rays, 400000u);
    EXPECT_GT(met, rays / 2);
    // Rounding bounds cost something, but not much.
    EXPECT_LT(more, met / 10) << more << " of " << met;
}

TEST(BvhNode, AbsentChildrenAreInNoGroupAndEmpty) {
    const BvhNode node = packNode({});
    EXPECT_EQ(node.groups, 0u);
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        EXPECT_TRUE(childBounds(node, slot).empty());
        EXPECT_EQ(leafCount(node.child[slot]), 0u);
    }
}

} // namespace
} // namespace q3rt
