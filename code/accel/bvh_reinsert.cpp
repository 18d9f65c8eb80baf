#include "accel/bvh_reinsert.hpp"

#include <algorithm>

namespace q3rt {
namespace {

/// What is largest is moved first: a third of the subtrees, in two rounds, gives nearly all that moving all of them
/// until nothing moves does, in a seventh of the time.
constexpr int kRounds = 2;
constexpr float kShareOfSubtrees = 0.3f;
/// Of one search, which looks at 22 in a map on average: the time stays proportional to the items, whatever they are.
constexpr int kMostPlaces = 1000;

constexpr uint32_t kNone = 0xffffffffu;

float joinedArea(Box4 a, const Box4& b) {
    a.add(b);
    return a.halfArea();
}

/// The tree with leaves as nodes of their own, and with the way up.
class Reinsertion {
  public:
    Reinsertion(std::vector<BuildNode>& tree, uint32_t root)
        : m_tree(tree)
        , m_root(root)
        , m_nodes(tree.size()) {
        m_nodes.reserve(2 * tree.size() + 1);
        m_inner.push_back(root);
        for (size_t i = 0; i < m_inner.size(); ++i)
            for (int side = 0; side < 2; ++side)
                addChild(m_inner[i], side);
        fit(root);
    }

    void run() {
        for (int round = 0; round < kRounds; ++round)
            for (const uint32_t node : largestSubtrees())
                reinsert(node);
    }

    uint32_t depth() const {
        std::vector<uint32_t> depths(m_nodes.size(), 0);
        std::vector<uint32_t> open{m_root};
        uint32_t deepest = 0;
        while (!open.empty()) {
            const uint32_t node = open.back();
            open.pop_back();
            depths[node] = node == m_root ? 1 : depths[m_nodes[node].parent] + 1;
            deepest = std::max(deepest, depths[node]);
            for (const uint32_t child : m_nodes[node].child)
                if (!isLeaf(child)) open.push_back(child);
        }
        return deepest;
    }

    void writeBack() {
        for (const uint32_t node : m_inner)
            for (int side = 0; side < 2; ++side) {
                const uint32_t child = m_nodes[node].child[side];
                m_tree[node].child[side] = isLeaf(child) ? m_leaves[child - m_tree.size()]
                                                         : BuildChild{m_nodes[child].box, 0, 0, child, false};
            }
    }

  private:
    struct Node {
        Box4 box;
        float area = 0;
        uint32_t parent = kNone;
        uint32_t child[2] = {kNone, kNone};
    };
    /// Beside `node`, below a new parent of both.
    struct Place {
        uint32_t node;
        float gain; ///< of area, before the new parent's is paid
    };
    std::vector<BuildNode>& m_tree;
    uint32_t m_root;
    std::vector<Node> m_nodes; ///< inner ones have their numbers of m_tree; then leaves
    std::vector<uint32_t> m_inner;
    std::vector<BuildChild> m_leaves;
    std::vector<Place> m_open; ///< of the search under way

    void addChild(uint32_t parent, int side) {
        const BuildChild& child = m_tree[parent].child[side];
        uint32_t node = child.node;
        if (child.leaf) {
            node = static_cast<uint32_t>(m_nodes.size());
            m_nodes.emplace_back();
            m_leaves.push_back(child);
        } else {
            m_inner.push_back(node);
        }
        m_nodes[node].box = child.box;
        m_nodes[node].area = child.box.halfArea();
        m_nodes[node].parent = parent;
        m_nodes[parent].child[side] = node;
    }

    bool isLeaf(uint32_t node) const { return node >= m_tree.size(); }
    uint32_t siblingOf(uint32_t node) const {
        const Node& parent = m_nodes[m_nodes[node].parent];
        return parent.child[parent.child[0] == node ? 1 : 0];
    }
    void fit(uint32_t node) {
        Node& n = m_nodes[node];
        n.box = m_nodes[n.child[0]].box;
        n.box.add(m_nodes[n.child[1]].box);
        n.area = n.box.halfArea();
    }
    void fitUpwards(uint32_t node) {
        for (; node != kNone; node = m_nodes[node].parent)
            fit(node);
    }

    /// The root and its children stay.
    bool mayMove(uint32_t node) const { return m_nodes[node].parent != kNone && m_nodes[node].parent != m_root; }

    std::vector<uint32_t> largestSubtrees() const {
        std::vector<uint32_t> subtrees;
        for (uint32_t node = 0; node < m_nodes.size(); ++node)
            if (mayMove(node)) subtrees.push_back(node);
        const auto isLarger = [&](uint32_t a, uint32_t b) {
            return m_nodes[a].area != m_nodes[b].area ? m_nodes[a].area > m_nodes[b].area : a < b;
        };
        const auto end =
            subtrees.begin() + static_cast<ptrdiff_t>(kShareOfSubtrees * static_cast<float>(subtrees.size()));
        std::nth_element(subtrees.begin(), end, subtrees.end(), isLarger);
        subtrees.erase(end, subtrees.end());
        std::sort(subtrees.begin(), subtrees.end(), isLarger);
        return subtrees;
    }

    /// Moves a subtree to the best place that is found: from its parent up to the root, what hangs beside that path is
    /// searched as far as it can still gain.
    void reinsert(uint32_t node) {
        if (!mayMove(node)) return; // others have moved
        const uint32_t parent = m_nodes[node].parent, sibling = siblingOf(node);
        Place best{kNone, 0};
        int places = kMostPlaces;
        float gain = m_nodes[parent].area; // the parent vanishes, and what is above it shrinks
        Box4 without;                      // what is left there
        for (uint32_t below = node; below != m_root && places > 0; below = m_nodes[below].parent) {
            const uint32_t beside = siblingOf(below), above = m_nodes[below].parent;
            search({beside, gain}, node, sibling, best, places);
            without.add(m_nodes[beside].box);
            if (above != parent) gain += m_nodes[above].area - without.halfArea();
        }
        if (best.node != kNone) move(node, best.node);
    }

    /// Below `from`, for a place of `node` that gains more than `best`.
    void search(const Place& from, uint32_t node, uint32_t sibling, Place& best, int& places) {
        const Box4& box = m_nodes[node].box;
        const float area = m_nodes[node].area;
        m_open.assign(1, from);
        while (!m_open.empty() && --places > 0) {
            const Place at = m_open.back();
            m_open.pop_back();
            if (at.gain - area <= best.gain) continue;
            const float joined = joinedArea(box, m_nodes[at.node].box);
            // Beside its sibling it is now.
            if (at.gain - joined > best.gain && at.node != sibling) best = {at.node, at.gain - joined};
            if (isLeaf(at.node)) continue;
            const float inside = at.gain - (joined - m_nodes[at.node].area);
            if (inside - area <= best.gain) continue;
            for (const uint32_t child : m_nodes[at.node].child)
                m_open.push_back({child, inside});
        }
    }

    void replaceChild(uint32_t parent, uint32_t from, uint32_t to) {
        m_nodes[parent].child[m_nodes[parent].child[0] == from ? 0 : 1] = to;
        m_nodes[to].parent = parent;
    }

    void move(uint32_t node, uint32_t place) {
        const uint32_t parent = m_nodes[node].parent, sibling = siblingOf(node);
        replaceChild(m_nodes[parent].parent, parent, sibling);
        fitUpwards(m_nodes[sibling].parent);
        replaceChild(m_nodes[place].parent, place, parent);
        replaceChild(parent, sibling, place);
        fitUpwards(parent);
    }
};

} // namespace

void reinsertSubtrees(std::vector<BuildNode>& tree, uint32_t root, std::vector<BuildItem>& items) {
    if (tree[root].child[0].leaf && tree[root].child[1].leaf) return;
    Reinsertion reinsertion(tree, root);
    reinsertion.run();
    if (reinsertion.depth() > kBvhMaxDepth) return;
    reinsertion.writeBack();
    orderItems(tree, root, items);
}

} // namespace q3rt
