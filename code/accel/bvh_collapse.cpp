#include "accel/bvh_collapse.hpp"

namespace q3rt {

Collapse::Collapse(const std::vector<BuildNode>& tree, uint32_t root, const BvhBuildSettings& settings)
    : m_tree(tree)
    , m_plans(tree.size()) {
    struct Visit {
        uint32_t node;
        float area;
    };
    // A parent before its children; planned backwards.
    std::vector<Visit> visits;
    visits.reserve(tree.size());
    Box4 whole = tree[root].child[0].box;
    whole.add(tree[root].child[1].box);
    visits.push_back({root, whole.halfArea()});
    for (size_t i = 0; i < visits.size(); ++i)
        for (const BuildChild& child : tree[visits[i].node].child)
            if (!child.leaf) visits.push_back({child.node, child.box.halfArea()});
    for (size_t i = visits.size(); i-- > 0;)
        plan(visits[i].node, visits[i].area, settings);
}

float Collapse::costOf(const BuildChild& child, uint32_t places) const {
    return child.leaf ? child.box.halfArea() * static_cast<float>(child.count) : m_plans[child.node].cost[places];
}

void Collapse::plan(uint32_t node, float area, const BvhBuildSettings& settings) {
    const BuildChild &left = m_tree[node].child[0], &right = m_tree[node].child[1];
    Plan& plan = m_plans[node];
    float shared[kBvhWidth + 1];
    for (uint32_t places = 2; places <= kBvhWidth; ++places) {
        shared[places] = std::numeric_limits<float>::max();
        for (uint32_t k = 1; k < places; ++k) {
            const float cost = costOf(left, k) + costOf(right, places - k);
            if (cost < shared[places]) {
                shared[places] = cost;
                plan.leftPlaces[places] = static_cast<uint8_t>(k);
            }
        }
    }
    plan.cost[1] = shared[kBvhWidth] + settings.traversalCost * area;
    const uint32_t count = left.count + right.count;
    const float leafCost = area * static_cast<float>(count);
    if (count <= leafLimit(settings) && leafCost <= plan.cost[1]) {
        plan.cost[1] = leafCost;
        plan.leaf = true;
    }
    for (uint32_t places = 2; places < kBvhWidth; ++places) {
        plan.cost[places] = shared[places];
        if (plan.cost[places - 1] <= shared[places]) {
            plan.cost[places] = plan.cost[places - 1];
            plan.leftPlaces[places] = 0;
        }
    }
}

WideChildren Collapse::childrenOf(uint32_t node) const {
    WideChildren wide;
    const uint32_t places = m_plans[node].leftPlaces[kBvhWidth];
    addChildren(m_tree[node].child[0], places, wide);
    addChildren(m_tree[node].child[1], kBvhWidth - places, wide);
    return wide;
}

void Collapse::addChildren(const BuildChild& child, uint32_t places, WideChildren& wide) const {
    if (child.leaf) {
        if (child.count > 0) wide.child[wide.count++] = {&child, true};
        return;
    }
    const Plan& plan = m_plans[child.node];
    while (places > 1 && plan.leftPlaces[places] == 0)
        --places;
    if (places == 1) {
        wide.child[wide.count++] = {&child, plan.leaf};
        return;
    }
    addChildren(m_tree[child.node].child[0], plan.leftPlaces[places], wide);
    addChildren(m_tree[child.node].child[1], places - plan.leftPlaces[places], wide);
}

} // namespace q3rt
