// A tree that is fitted to a model's new pose holds the triangles that a tree built from it holds, and says when it
// can't be.

#include <array>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "renderer_rt/moving_trees.hpp"

namespace q3rt {
namespace {

/// Two surfaces of a model that breathes and turns, of different classes.
class Dancer {
  public:
    explicit Dancer(float phase) {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> spread(-20, 20);
        for (uint32_t i = 0; i < kTriangles; ++i) {
            const vec3 at(spread(random), spread(random), spread(random));
            for (const vec3& corner : {vec3(0), vec3(2, 0, 1), vec3(0, 2, 1)}) {
                const vec3 still = at + corner;
                const float swing = phase * still.z / 20;
                vertices.push_back({.position = {still.x * std::cos(swing) - still.y * std::sin(swing),
                                                 still.x * std::sin(swing) + still.y * std::cos(swing), still.z}});
                indices.push_back(i % kPerPart * 3 + static_cast<uint32_t>(vertices.size() - 1) % 3);
            }
        }
    }
    std::array<TreePart, 2> parts() const {
        const std::span<const Vertex> all(vertices);
        const std::span<const uint32_t> numbers(indices);
        return {TreePart{all.first(3 * kPerPart), numbers.first(3 * kPerPart), SurfaceClass::Solid},
                TreePart{all.last(3 * kPerPart), numbers.last(3 * kPerPart), SurfaceClass::Layer}};
    }
    static constexpr uint32_t kPerPart = 100, kTriangles = 2 * kPerPart;
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
};

constexpr std::array<uint64_t, 2> kKey{3, 4};

using TriangleTuple = std::tuple<uint32_t, uint32_t, float, float, float, float>;
std::set<TriangleTuple> trianglesOf(const TreeData& tree) {
    std::set<TriangleTuple> all;
    for (const BvhTriangle& t : tree.triangles)
        all.insert({t.number, t.flags, t.corner0.x, t.corner1.y, t.corner2.x, t.corner2.z});
    return all;
}

TEST(MovingTrees, AFittedTreeHoldsTheTrianglesOfItsPose) {
    MovingTrees trees;
    EXPECT_TRUE(trees.make(kKey, Dancer(0).parts()).built);
    for (const float phase : {0.1f, 0.3f, 0.0f}) {
        const Dancer pose(phase);
        const MovingTrees::Made fitted = trees.make(kKey, pose.parts());
        EXPECT_FALSE(fitted.built);
        const TreeData built = buildTree(pose.parts(), true);
        EXPECT_EQ(trianglesOf(fitted.tree), trianglesOf(built));
        EXPECT_EQ(fitted.tree.bvh.bounds.mins, built.bvh.bounds.mins);
        EXPECT_EQ(fitted.tree.bvh.bounds.maxs, built.bvh.bounds.maxs);
    }
}

TEST(MovingTrees, WhatCannotBeFittedIsBuilt) {
    MovingTrees trees;
    const Dancer still(0);
    trees.make(kKey, still.parts());
    EXPECT_TRUE(trees.make({}, still.parts()).built) << "unknown";
    const auto parts = still.parts();
    EXPECT_TRUE(trees.make(kKey, std::span(parts).first(1)).built) << "other parts";
    trees.make(kKey, still.parts());
    Dancer other(0);
    std::swap(other.indices[0], other.indices[4]);
    EXPECT_TRUE(trees.make(kKey, other.parts()).built) << "other triangles";
    trees.make(kKey, still.parts());
    Dancer odd(0);
    odd.vertices[5].position.y = NAN;
    const MovingTrees::Made broken = trees.make(kKey, odd.parts());
    EXPECT_TRUE(broken.built);
    EXPECT_EQ(broken.tree.bvh.rejectedCount, 1u);
    EXPECT_EQ(trees.make(kKey, still.parts()).tree.triangles.size(), Dancer::kTriangles) << "it is back";
    Dancer scattered(0);
    std::shuffle(scattered.vertices.begin(), scattered.vertices.end(), std::mt19937(1));
    EXPECT_TRUE(trees.make(kKey, scattered.parts()).built) << "neighbours are far apart: a fitted tree would be slow";
}

TEST(MovingTrees, ACrowdComesIntoSightInQuickTrees) {
    MovingTrees trees;
    const Dancer still(0);
    constexpr uint64_t kCrowd = 20;
    float costAtFirst = 0, costAtLast = 0;
    for (uint64_t frame = 0; frame < kCrowd; ++frame) {
        trees.beginFrame();
        size_t built = 0;
        for (uint64_t one = 1; one <= kCrowd; ++one) {
            const MovingTrees::Made made = trees.make(std::array{one}, still.parts());
            built += made.built ? Dancer::kTriangles : 0;
            (frame == 0 ? costAtFirst : costAtLast) = surfaceAreaCost(made.tree.bvh); // in the end the last one's
        }
        if (frame == 0) {
            EXPECT_EQ(built, kCrowd * Dancer::kTriangles) << "all are there at once";
        } else {
            EXPECT_LE(built, 1000u) << frame;
        }
    }
    EXPECT_LT(costAtLast, costAtFirst) << "and all are good in the end";
}

TEST(MovingTrees, ForgetsWhatIsNoLongerShown) {
    MovingTrees trees;
    const Dancer still(0);
    trees.make(kKey, still.parts());
    for (int frame = 0; frame < 2000; ++frame)
        trees.beginFrame();
    EXPECT_TRUE(trees.make(kKey, still.parts()).built);
}

} // namespace
} // namespace q3rt
