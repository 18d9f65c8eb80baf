// What makes trees cheap: the collapse to four children against all collapses there are, and subtrees that move.

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "accel/bvh_collapse.hpp"
#include "accel/bvh_node.hpp"
#include "accel/bvh_reinsert.hpp"
#include "accel/shader_traversal.hpp"

namespace q3rt {
namespace {

using Random = std::mt19937;

float uniform(Random& random, float low, float high) {
    return low + (high - low) * (static_cast<float>(random() >> 8) * 0x1p-24f);
}

/// Triangles that are long in one direction, as those of maps are.
std::vector<vec3> longTriangles(Random& random, size_t count) {
    std::vector<vec3> positions;
    for (size_t i = 0; i < count; ++i) {
        const vec3 centre(uniform(random, -900, 900), uniform(random, -900, 900), uniform(random, -300, 300));
        vec3 size(4);
        size[static_cast<int>(random() % 3)] = uniform(random, 4, 250);
        for (int corner = 0; corner < 3; ++corner)
            positions.push_back(centre +
                                size * vec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)));
    }
    return positions;
}

/// A binary tree of random shape over leaves of one to three items; [0] the root.
std::vector<BuildNode> randomTree(Random& random, uint32_t leafCount, std::vector<BuildItem>& items) {
    std::vector<BuildNode> tree(1);
    std::vector<std::pair<BuildChild*, uint32_t>> open;
    tree.reserve(leafCount);
    const uint32_t left = 1 + random() % (leafCount - 1);
    open.emplace_back(&tree[0].child[0], left);
    open.emplace_back(&tree[0].child[1], leafCount - left);
    while (!open.empty()) {
        const auto [child, leaves] = open.back();
        open.pop_back();
        const vec3 low(uniform(random, 0, 9), uniform(random, 0, 9), uniform(random, 0, 9));
        child->box = Box4(Bounds{low, low + vec3(uniform(random, 0, 9), uniform(random, 0, 9), uniform(random, 0, 9))});
        if (leaves == 1) {
            child->first = static_cast<uint32_t>(items.size());
            child->count = 1 + random() % 3;
            for (uint32_t i = 0; i < child->count; ++i)
                items.push_back({child->box, child->first + i});
            continue;
        }
        child->leaf = false;
        child->node = static_cast<uint32_t>(tree.size());
        tree.emplace_back();
        const uint32_t first = 1 + random() % (leaves - 1);
        open.emplace_back(&tree[child->node].child[0], first);
        open.emplace_back(&tree[child->node].child[1], leaves - first);
    }
    return tree;
}

/// The cheapest collapse by trying all.
class EveryCollapse {
  public:
    EveryCollapse(const std::vector<BuildNode>& tree, const BvhBuildSettings& settings)
        : m_tree(tree)
        , m_settings(settings) {}
    /// What the children of a node that stays cost.
    float costBelow(uint32_t node) const {
        float best = std::numeric_limits<float>::max();
        tryOpening({&m_tree[node].child[0], &m_tree[node].child[1]}, 0, best);
        return best;
    }

  private:
    using Front = std::vector<const BuildChild*>;
    const std::vector<BuildNode>& m_tree;
    const BvhBuildSettings& m_settings;

    float costOf(const BuildChild& child) const {
        const float area = child.box.halfArea(), asLeaf = area * static_cast<float>(child.count);
        if (child.leaf) return asLeaf;
        const float asNode = m_settings.traversalCost * area + costBelow(child.node);
        return child.count <= m_settings.maxLeafItems ? std::min(asLeaf, asNode) : asNode;
    }
    /// Children before `from` stay.
    void tryOpening(const Front& front, size_t from, float& best) const {
        float cost = 0;
        for (const BuildChild* child : front)
            cost += costOf(*child);
        best = std::min(best, cost);
        if (front.size() == kBvhWidth) return;
        for (size_t i = from; i < front.size(); ++i) {
            if (front[i]->leaf) continue;
            Front opened = front;
            opened[i] = &m_tree[front[i]->node].child[0];
            opened.push_back(&m_tree[front[i]->node].child[1]);
            tryOpening(opened, 0, best);
        }
    }
};

TEST(TreeQuality, TheCollapseIsTheCheapestOfAll) {
    Random random(1);
    size_t cases = 0, nodes = 0;
    for (int i = 0; i < 3000; ++i, ++cases) {
        const BvhBuildSettings settings{.maxLeafItems = 1 + static_cast<uint32_t>(random() % 6),
                                        .traversalCost = uniform(random, 0.3f, 3)};
        std::vector<BuildItem> items;
        std::vector<BuildNode> tree = randomTree(random, 2 + static_cast<uint32_t>(random() % 9), items);
        orderItems(tree, 0, items);
        const Bvh bvh = layOut(tree, 0, items, 0, settings);
        EXPECT_EQ(bvh.order.size(), items.size());
        // What the stored tree costs, by the boxes that it was made of.
        const Collapse collapse(tree, 0, settings);
        float cost = 0;
        std::vector<uint32_t> open{0};
        while (!open.empty()) {
            const WideChildren wide = collapse.childrenOf(open.back());
            open.pop_back();
            ++nodes;
            for (uint32_t slot = 0; slot < wide.count; ++slot) {
                const auto& [source, leaf] = wide.child[slot];
                cost += source->box.halfArea() * (leaf ? static_cast<float>(source->count) : settings.traversalCost);
                if (!leaf) open.push_back(source->node);
            }
        }
        ASSERT_NEAR(cost, EveryCollapse(tree, settings).costBelow(0), 1e-5f * cost) << "tree " << i;
    }
    EXPECT_EQ(cases, 3000u);
    EXPECT_GT(nodes, cases);
}

TEST(TreeQuality, MovedSubtreesCostLessAndFindTheSame) {
    Random random(2);
    const std::vector<vec3> positions = longTriangles(random, 6000);
    const std::vector<Bounds> boxes = triangleBounds(positions);
    TestScene scenes[2];
    float cost[2];
    for (int moved = 0; moved < 2; ++moved) {
        const Bvh bvh = buildSah(boxes, {.reinsert = moved == 1});
        cost[moved] = surfaceAreaCost(bvh);
        std::vector<uint32_t> order = bvh.order;
        std::sort(order.begin(), order.end());
        ASSERT_EQ(order.size(), boxes.size());
        for (uint32_t i = 0; i < order.size(); ++i)
            ASSERT_EQ(order[i], i);
        scenes[moved].instances.push_back(scenes[moved].addModel(bvh, positions));
        scenes[moved].buildScene({bvh.bounds});
    }
    EXPECT_LT(cost[1], 0.97f * cost[0]);
    size_t hits = 0, visits[2] = {};
    for (int i = 0; i < 20000; ++i) {
        const vec3 origin(uniform(random, -900, 900), uniform(random, -900, 900), uniform(random, -300, 300));
        const vec3 direction(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        TestHit hit[2];
        for (int moved = 0; moved < 2; ++moved) {
            hit[moved] = traceShader(scenes[moved], origin, direction, 0, 1e4f);
            visits[moved] += hit[moved].visitCount;
        }
        ASSERT_EQ(hit[0].hit, hit[1].hit) << i;
        ASSERT_EQ(hit[0].t, hit[1].t) << i;
        hits += hit[0].hit ? 1 : 0;
    }
    EXPECT_GT(hits, 2000u);
    EXPECT_LT(visits[1], visits[0]);
}

/// Walks through a subtree; false if its items are not the next ones.
bool walksInOrder(const Bvh& bvh, uint32_t node, uint32_t& next) {
    for (uint32_t slot = 0; slot < kBvhWidth; ++slot) {
        const uint32_t child = bvh.nodes[node].child[slot];
        if (groupsOf(bvh.nodes[node], slot) == 0) continue;
        if (child & kBvhLeafBit) {
            if (leafFirst(child) != next) return false;
            next += leafCount(child);
        } else if (!walksInOrder(bvh, child, next)) {
            return false;
        }
    }
    return true;
}

TEST(TreeQuality, ItemsAreInTheOrderOfTheWalk) {
    // A driver that halves this order again and again (lavapipe) makes a tree that is twice as slow in another one.
    Random random(3);
    const std::vector<Bounds> boxes = triangleBounds(longTriangles(random, 3000));
    size_t cases = 0;
    for (const Bvh& bvh : {buildSah(boxes), buildSah(boxes, {.reinsert = true}), buildMorton(boxes),
                           buildPairing(std::span(boxes).first(500))}) {
        uint32_t next = 0;
        EXPECT_TRUE(walksInOrder(bvh, 0, next)) << "tree " << cases;
        EXPECT_EQ(next, bvh.order.size());
        ++cases;
    }
    EXPECT_EQ(cases, 4u);
}

TEST(TreeQuality, OddTreesStayWithinTheDepthBoundAndTakeNoLonger) {
    const BvhBuildSettings settings{.maxLeafItems = 1, .reinsert = true};
    // Geometric spacing: a chain, from which nothing is moved that would make it too deep.
    std::vector<Bounds> chain;
    for (int i = 0; i < 250; ++i)
        chain.push_back({vec3(std::ldexp(1.0f, i / 2 - 60)), vec3(std::ldexp(1.0f, i / 2 - 60))});
    // All boxes the same, all around the same place, none larger than a point.
    std::vector<Bounds> same(5000, Bounds{vec3(1), vec3(2)}), around, points(5000, Bounds{vec3(3), vec3(3)});
    for (int i = 0; i < 5000; ++i)
        around.push_back({vec3(-1 - static_cast<float>(i)), vec3(1 + static_cast<float>(i))});
    for (const std::vector<Bounds>& boxes : {chain, same, around, points, std::vector<Bounds>(1, same[0]),
                                             std::vector<Bounds>(2, same[0]), std::vector<Bounds>{}}) {
        const Bvh bvh = buildSah(boxes, settings);
        EXPECT_EQ(bvh.order.size() + bvh.rejectedCount, boxes.size());
        EXPECT_LE(depthOf(bvh), kBvhMaxDepth);
    }
}

} // namespace
} // namespace q3rt
