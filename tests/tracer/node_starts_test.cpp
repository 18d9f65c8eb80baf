// The search for a point's cluster that begins at a grid's cell ends where the one from the root does.

#include <gtest/gtest.h>
#include <random>

#include "renderer_rt/node_starts.hpp"

namespace q3rt {
namespace {

/// As the shader does it, in binary32.
int leafBelow(const std::vector<RtNode>& nodes, int node, const vec3& point) {
    while (node >= 0) {
        const RtNode& at = nodes[static_cast<size_t>(node)];
        node = glm::dot(at.plane.normal, point) - at.plane.distance > 0.0f ? at.front : at.back;
    }
    return node;
}

/// A full tree whose planes pass near random points; every leaf is a cluster of its own.
std::vector<RtNode> makeTree(std::mt19937& random, int depth, float extent) {
    std::uniform_real_distribution<float> within(-extent, extent), unit(-1, 1);
    const int inner = (1 << depth) - 1;
    std::vector<RtNode> nodes;
    for (int i = 0; i < inner; ++i) {
        const bool axial = i % 3 != 0;
        vec3 normal(0);
        normal[i % 3] = 1;
        if (!axial) normal = glm::normalize(vec3(unit(random), unit(random), unit(random) + 2));
        const float distance = axial ? std::round(within(random)) : within(random);
        const auto child = [&](int c) { return c < inner ? c : -2 - (c - inner); };
        nodes.push_back({{normal, distance}, child(2 * i + 1), child(2 * i + 2)});
    }
    return nodes;
}

TEST(NodeStarts, LeadToTheLeafThatTheRootLeadsTo) {
    std::mt19937 random(9);
    for (const float extent : {100.0f, 3000.0f, 60000.0f}) {
        const std::vector<RtNode> nodes = makeTree(random, 9, extent);
        const NodeStarts starts = findNodeStarts(nodes, vec3(-extent), vec3(extent));
        ASSERT_EQ(starts.starts.size(), size_t(starts.counts.x) * starts.counts.y * starts.counts.z);
        std::uniform_real_distribution<float> within(-extent, extent);
        int skipped = 0;
        for (int i = 0; i < 100000; ++i) {
            vec3 point(within(random), within(random), within(random));
            if (i % 2 == 0) point = glm::round(point); // on planes and on cells' borders
            const ivec3 cell(glm::floor((point - starts.origin) / starts.cellQu));
            ASSERT_TRUE(glm::all(glm::lessThan(cell, starts.counts)));
            const int start =
                starts.starts[static_cast<size_t>(cell.x + starts.counts.x * (cell.y + starts.counts.y * cell.z))];
            ASSERT_EQ(leafBelow(nodes, start, point), leafBelow(nodes, 0, point));
            skipped += start != 0;
        }
        EXPECT_GT(skipped, 10000);
    }
}

TEST(NodeStarts, OfNothingAreNone) { EXPECT_TRUE(findNodeStarts({}, vec3(0), vec3(1)).starts.empty()); }

} // namespace
} // namespace q3rt
