// Binned surface-area heuristic, top down (Wald 2007). 16 bins an axis; all three axes are binned in one pass.
// Subtrees are independent ranges of items and of nodes, so threads can build them and the result stays the same.

#include <algorithm>
#include <array>
#include <thread>

#include "accel/bvh_reinsert.hpp"
#include "accel/bvh_tree.hpp"

namespace q3rt {
namespace {

constexpr int kMostBins = 16;
constexpr uint32_t kBinsPerItem = 2;
/// Below this a thread costs more to start than the subtree costs to build (about 0.2 microseconds an item).
constexpr uint32_t kMinItemsOfThread = 4096;

struct Bin {
    Box4 box;
    uint32_t count = 0;
};
using AxisBins = std::array<Bin, kMostBins>;

struct Split {
    float cost = std::numeric_limits<float>::max(); ///< sum of half area x count of both sides
    int axis = -1;
    int bin = 0; ///< first bin of the right side
};

struct Range {
    Box4 box, centres;
    uint32_t first = 0, count = 0;
};

class SahBuilder {
  public:
    SahBuilder(std::vector<BuildItem>& items, const BvhBuildSettings& settings)
        : m_items(items)
        , m_settings(settings) {
        m_tree.resize(std::max<size_t>(items.size(), 1));
    }

    std::vector<BuildNode>& build() {
        Range all{{}, {}, 0, static_cast<uint32_t>(m_items.size())};
        for (const BuildItem& item : m_items) {
            all.box.add(item.box);
            all.centres.addPoint(item.box.doubleCentre());
        }
        if (all.count <= 1) {
            m_tree[0].child[0] = {all.box, 0, all.count, 0, true};
            return m_tree;
        }
        buildNode(0, all, 0, std::max(1u, m_settings.threadCount));
        return m_tree;
    }

  private:
    std::vector<BuildItem>& m_items;
    const BvhBuildSettings& m_settings;
    std::vector<BuildNode> m_tree; ///< a range of n items owns n - 1 slots from its node on; unused ones stay empty

    /// `range` has at least two items.
    void buildNode(uint32_t node, const Range& range, uint32_t depth, unsigned threads) {
        Range sides[2];
        splitRange(range, depth, sides);
        const uint32_t childNode[2] = {node + 1, node + sides[0].count};
        for (int side = 0; side < 2; ++side) {
            const bool leaf = becomesLeaf(sides[side]);
            m_tree[node].child[side] = {sides[side].box, sides[side].first, sides[side].count, childNode[side], leaf};
        }
        const bool apart = threads > 1 && std::min(sides[0].count, sides[1].count) >= kMinItemsOfThread;
        std::thread other;
        if (apart && !m_tree[node].child[1].leaf)
            other = std::thread([&, depth] { buildNode(childNode[1], sides[1], depth + 1, threads / 2); });
        if (!m_tree[node].child[0].leaf)
            buildNode(childNode[0], sides[0], depth + 1, apart ? threads - threads / 2 : threads);
        if (other.joinable())
            other.join();
        else if (!m_tree[node].child[1].leaf)
            buildNode(childNode[1], sides[1], depth + 1, threads);
    }

    bool becomesLeaf(const Range& range) const {
        if (range.count <= 1) return true;
        if (range.count > leafLimit(m_settings)) return false;
        const float leafCost = static_cast<float>(range.count);
        const float area = range.box.halfArea();
        if (area <= 0) return true;
        const Split split = findSplit(range);
        return split.axis < 0 || m_settings.traversalCost + split.cost / area >= leafCost;
    }

    /// Few items need few bins.
    static int binCount(const Range& range) {
        return static_cast<int>(std::min(uint32_t{kMostBins}, kBinsPerItem * range.count));
    }
    /// `scale` never reaches past the last bin by more than rounding.
    static int binOf(float doubleCentre, float low, float scale, int bins) {
        return std::clamp(static_cast<int>((doubleCentre - low) * scale), 0, bins - 1);
    }

    /// Bins per unit of doubled centre; 0 where the centres don't spread (or spread too little to be divided).
    static float binScale(const Range& range, int axis) {
        const float extent = range.centres.maxs[axis] - range.centres.mins[axis];
        const float scale = static_cast<float>(binCount(range)) / extent;
        return extent > 0 && scale < std::numeric_limits<float>::max() ? scale : 0;
    }

    Split findSplit(const Range& range) const {
        AxisBins bins[3];
        const int binsUsed = binCount(range);
        const float scale[3] = {binScale(range, 0), binScale(range, 1), binScale(range, 2)};
        for (uint32_t i = range.first; i < range.first + range.count; ++i) {
            const Float4 centre = m_items[i].box.doubleCentre();
            for (int axis = 0; axis < 3; ++axis) {
                Bin& bin =
                    bins[axis]
                        [static_cast<size_t>(binOf(centre[axis], range.centres.mins[axis], scale[axis], binsUsed))];
                bin.box.add(m_items[i].box);
                ++bin.count;
            }
        }
        Split best;
        for (int axis = 0; axis < 3; ++axis)
            if (scale[axis] > 0) sweepAxis(bins[axis], binsUsed, axis, best);
        return best;
    }

    static void sweepAxis(const AxisBins& bins, int binsUsed, int axis, Split& best) {
        std::array<float, kMostBins> rightCost{};
        Box4 box;
        uint32_t count = 0;
        for (int i = binsUsed - 1; i > 0; --i) {
            box.add(bins[static_cast<size_t>(i)].box);
            count += bins[static_cast<size_t>(i)].count;
            rightCost[static_cast<size_t>(i)] = count == 0 ? -1.0f : box.halfArea() * static_cast<float>(count);
        }
        box = {};
        count = 0;
        for (int i = 1; i < binsUsed; ++i) {
            box.add(bins[static_cast<size_t>(i) - 1].box);
            count += bins[static_cast<size_t>(i) - 1].count;
            if (count == 0 || rightCost[static_cast<size_t>(i)] < 0) continue;
            const float cost = box.halfArea() * static_cast<float>(count) + rightCost[static_cast<size_t>(i)];
            if (cost < best.cost) best = {cost, axis, i};
        }
    }

    void splitRange(const Range& range, uint32_t depth, Range sides[2]) {
        const Split split = mustHalve(depth, range.count) ? Split{} : findSplit(range);
        uint32_t middle = 0;
        if (split.axis < 0) {
            middle = middleOf(range.first, range.count);
        } else {
            const float low = range.centres.mins[split.axis], scale = binScale(range, split.axis);
            const auto begin = m_items.begin() + range.first;
            middle = static_cast<uint32_t>(std::partition(begin, begin + range.count,
                                                          [&](const BuildItem& item) {
                                                              return binOf(item.box.doubleCentre()[split.axis], low,
                                                                           scale, binCount(range)) < split.bin;
                                                          }) -
                                           m_items.begin());
        }
        sides[0] = measure(range.first, middle - range.first);
        sides[1] = measure(middle, range.first + range.count - middle);
    }

    Range measure(uint32_t first, uint32_t count) const {
        Range range{{}, {}, first, count};
        for (uint32_t i = first; i < first + count; ++i) {
            range.box.add(m_items[i].box);
            range.centres.addPoint(m_items[i].box.doubleCentre());
        }
        return range;
    }
};

} // namespace

Bvh buildSah(std::span<const Bounds> boxes, const BvhBuildSettings& settings) {
    uint32_t rejected = 0;
    std::vector<BuildItem> items = collectItems(boxes, rejected);
    SahBuilder builder(items, settings);
    std::vector<BuildNode>& tree = builder.build();
    if (settings.reinsert) reinsertSubtrees(tree, 0, items);
    return layOut(tree, 0, items, rejected, settings);
}

} // namespace q3rt
