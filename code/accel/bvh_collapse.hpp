#pragma once
// From a binary tree to nodes of four children: which inner nodes vanish, and which subtrees become leaves.

#include "accel/bvh_tree.hpp"

namespace q3rt {

/// A child of a node of four.
struct WideChild {
    const BuildChild* source = nullptr;
    bool leaf = true; ///< of all its items
};
struct WideChildren {
    WideChild child[kBvhWidth];
    uint32_t count = 0;
};

/// The cheapest of all trees of four children a node that come from a binary tree by leaving out inner nodes and by
/// making leaves of small subtrees (Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through
/// Compressed Wide BVHs", section 3.1).
class Collapse {
  public:
    Collapse(const std::vector<BuildNode>& tree, uint32_t root, const BvhBuildSettings& settings);
    /// Of a binary node that stays.
    WideChildren childrenOf(uint32_t node) const;

  private:
    /// What a subtree costs that is given up to n places in its parent, n = 1 to kBvhWidth - 1, and how.
    struct Plan {
        float cost[kBvhWidth] = {};             ///< [0] unused
        uint8_t leftPlaces[kBvhWidth + 1] = {}; ///< of its left child; 0: fewer places do; [kBvhWidth]: of its own node
        bool leaf = false;                      ///< if it has one place
    };
    const std::vector<BuildNode>& m_tree;
    std::vector<Plan> m_plans;

    float costOf(const BuildChild& child, uint32_t places) const;
    void plan(uint32_t node, float area, const BvhBuildSettings& settings);
    void addChildren(const BuildChild& child, uint32_t places, WideChildren& wide) const;
};

} // namespace q3rt
