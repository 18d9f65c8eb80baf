// A node's boxes hold what was put in, exactly and no larger than the grid forces; and no ray that meets a box in exact
// arithmetic passes it by.

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

uint32_t byteOf(uint32_t word, uint32_t slot) { return word >> (8 * slot) & 0xffu; }

/// Checks one axis of the child `slot`.
void expectTight(const BvhNode& node, uint32_t slot, int axis, const Interval& given, bool mayBeLast) {
    const uint32_t lows[3] = {node.lowX, node.lowY, node.lowZ}, highs[3] = {node.highX, node.highY, node.highZ};
    const int exponent = static_cast<int>(node.scales >> (8 * axis) & 0xffu) - 127;
    const Exact cell = std::ldexp(1.0, exponent), origin = node.origin[axis];
    const Exact low = byteOf(lows[axis], slot), high = byteOf(highs[axis], slot);
    ASSERT_TRUE(origin + low * cell <= Exact(given.low));
    ASSERT_TRUE(origin + high * cell >= Exact(given.high));
    // One cell less would not do, and half the cell would not either.
    ASSERT_TRUE(origin + (low + 1) * cell > Exact(given.low));
    ASSERT_TRUE(high == 0 || origin + (high - 1) * cell < Exact(given.high));
    if (mayBeLast && exponent > -126) {
        ASSERT_GT(high, Exact(127));
    }
}

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

TEST(BvhNode, CellBoundariesAreExact) {
    // Bounds at, just below and just above every cell boundary, for origins that are whole cells and that are not.
    size_t cases = 0;
    for (const float origin : {0.0f, -4096.0f, 1024.5f, 0.1f, -70000.3f, 1e-9f})
        for (const int exponent : {-20, -3, 0, 5}) {
            const float cell = std::ldexp(1.0f, exponent), end = origin + 255 * cell;
            if (!(end > origin)) continue;
            for (int q = 0; q <= 255; ++q)
                for (int nudge = -1; nudge <= 1; ++nudge) {
                    float x = origin + static_cast<float>(q) * cell;
                    if (nudge != 0) x = std::nextafter(x, nudge < 0 ? -1e30f : 1e30f);
                    x = std::min(std::max(x, origin), end);
                    const Interval whole{origin, end}, low{x, end}, high{origin, x}, point{x, x};
                    const std::array<std::array<Interval, 3>, 4> children{
                        {{whole, whole, whole}, {low, high, point}, {high, point, low}, {point, low, high}}};
                    const BvhNode node = makeNode(children);
                    for (uint32_t slot = 0; slot < kBvhWidth; ++slot)
                        for (int axis = 0; axis < 3; ++axis, ++cases)
                            expectTight(node, slot, axis, children[slot][static_cast<size_t>(axis)], slot == 0);
                }
        }
    EXPECT_GT(cases, 150000u);
}

TEST(BvhNode, AnySizesAndPlaces) {
    Random random(11);
    size_t cases = 0;
    for (int i = 0; i < 50000; ++i) {
        std::array<std::array<Interval, 3>, 4> children;
        for (auto& child : children)
            for (Interval& interval : child) {
                // Exponents from 2^-38 to 2^38, points among them.
                const float centre = std::ldexp(uniform(random, -2, 2), static_cast<int>(random() % 76) - 38);
                const float size =
                    i % 7 == 0 ? 0.0f : std::ldexp(uniform(random, 0, 2), static_cast<int>(random() % 76) - 38);
                interval = {std::min(centre, centre + size), std::max(centre, centre + size)};
            }
        const BvhNode node = makeNode(children);
        for (uint32_t slot = 0; slot < kBvhWidth; ++slot)
            for (int axis = 0; axis < 3; ++axis, ++cases)
                expectTight(node, slot, axis, children[slot][static_cast<size_t>(axis)], false);
    }
    EXPECT_EQ(cases, 600000u);
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
            const uint32_t bits = shader::boxesMet(node, origin, reciprocal, tMin, tMax, first);
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
    // The grid costs something, but not much.
    EXPECT_LT(more, met / 10) << more << " of " << met;
}

TEST(BvhNode, AbsentChildrenAreInNoGroupAndEmpty) {
    const BvhNode node = packNode({});
    EXPECT_EQ(node.scales >> 24, 0u);
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        EXPECT_TRUE(childBounds(node, slot).empty());
        EXPECT_EQ(leafCount(node.child[slot]), 0u);
    }
}

} // namespace
} // namespace q3rt
