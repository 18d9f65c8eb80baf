// Morton-binned build: items sorted by the interleaved bits of their quantised centres, split where the highest bit
// changes (Lauterbach et al. 2009, "Fast BVH Construction on GPUs"). Quality lower than SAH, time a fraction.

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "accel/bvh_tree.hpp"

namespace q3rt {
namespace {

constexpr uint32_t kBitsPerAxis = 10;

/// Spreads the low 10 bits so that two zero bits follow each.
uint32_t spreadBits(uint32_t value) {
    value = (value | (value << 16)) & 0x030000ffu;
    value = (value | (value << 8)) & 0x0300f00fu;
    value = (value | (value << 4)) & 0x030c30c3u;
    return (value | (value << 2)) & 0x09249249u;
}

struct Key {
    uint32_t code;
    uint32_t item;
};

/// Fewer keys are sorted faster by comparing them than by clearing and summing the radix sort's counters.
constexpr size_t kFewKeys = 64;

/// Radix sort, 3 passes of 10 bits; stable, so equal codes keep their input order.
void sortKeys(std::vector<Key>& keys) {
    if (keys.size() <= kFewKeys) {
        std::ranges::sort(keys, {}, [](const Key& key) { return uint64_t{key.code} << 32 | key.item; });
        return;
    }
    std::vector<Key> other(keys.size());
    for (uint32_t pass = 0; pass < 3; ++pass) {
        std::array<uint32_t, 1024> start{};
        const uint32_t shift = pass * kBitsPerAxis;
        for (const Key& key : keys)
            ++start[(key.code >> shift) & 1023];
        uint32_t sum = 0;
        for (uint32_t& entry : start)
            sum += std::exchange(entry, sum);
        for (const Key& key : keys)
            other[start[(key.code >> shift) & 1023]++] = key;
        keys.swap(other);
    }
}

std::vector<Key> mortonKeys(std::span<const BuildItem> items) {
    Box4 centres;
    for (const BuildItem& item : items)
        centres.addPoint(item.box.doubleCentre());
    const Float4 extent = centres.maxs - centres.mins;
    Float4 scale{};
    for (int axis = 0; axis < 3; ++axis) {
        const float cells = static_cast<float>((1u << kBitsPerAxis) - 1) / extent[axis];
        scale[axis] = extent[axis] > 0 && cells < std::numeric_limits<float>::max() ? cells : 0;
    }
    std::vector<Key> keys(items.size());
    for (uint32_t i = 0; i < items.size(); ++i) {
        const Float4 cell = (items[i].box.doubleCentre() - centres.mins) * scale;
        keys[i] = {spreadBits(static_cast<uint32_t>(cell[0])) << 2 | spreadBits(static_cast<uint32_t>(cell[1])) << 1 |
                       spreadBits(static_cast<uint32_t>(cell[2])),
                   i};
    }
    return keys;
}

class MortonBuilder {
  public:
    MortonBuilder(std::span<const BuildItem> items, std::span<const Key> keys, uint32_t maxLeafItems)
        : m_items(items)
        , m_keys(keys)
        , m_maxLeafItems(maxLeafItems) {
        m_tree.reserve(std::max<size_t>(items.size(), 1));
        m_tree.emplace_back();
    }

    const std::vector<BuildNode>& build() {
        const auto count = static_cast<uint32_t>(m_items.size());
        if (count <= 1)
            m_tree[0].child[0] = {count ? m_items[0].box : Box4{}, 0, count, 0, true};
        else
            buildNode(0, 0, count, 0);
        return m_tree;
    }

  private:
    std::span<const BuildItem> m_items; ///< in key order
    std::span<const Key> m_keys;
    uint32_t m_maxLeafItems;
    std::vector<BuildNode> m_tree;

    uint32_t splitOf(uint32_t first, uint32_t count, uint32_t depth) const {
        const uint32_t difference = m_keys[first].code ^ m_keys[first + count - 1].code;
        if (difference == 0 || mustHalve(depth, count)) return middleOf(first, count);
        const uint32_t bit = std::bit_floor(difference);
        const auto begin = m_keys.begin() + first;
        return static_cast<uint32_t>(
            std::partition_point(begin, begin + count, [bit](const Key& key) { return (key.code & bit) == 0; }) -
            m_keys.begin());
    }

    Box4 buildNode(uint32_t node, uint32_t first, uint32_t count, uint32_t depth) {
        const uint32_t middle = splitOf(first, count, depth);
        const uint32_t starts[2] = {first, middle}, counts[2] = {middle - first, first + count - middle};
        Box4 box;
        for (int side = 0; side < 2; ++side) {
            BuildChild child{{}, starts[side], counts[side], 0, counts[side] <= m_maxLeafItems};
            if (child.leaf) {
                for (uint32_t i = child.first; i < child.first + child.count; ++i)
                    child.box.add(m_items[i].box);
            } else {
                child.node = static_cast<uint32_t>(m_tree.size());
                m_tree.emplace_back();
                child.box = buildNode(child.node, child.first, child.count, depth + 1);
            }
            box.add(child.box);
            m_tree[node].child[side] = child;
        }
        return box;
    }
};

} // namespace

Bvh buildMorton(std::span<const Bounds> boxes, const BvhBuildSettings& settings) {
    uint32_t rejected = 0;
    const std::vector<BuildItem> items = collectItems(boxes, rejected);
    std::vector<Key> keys = mortonKeys(items);
    sortKeys(keys);
    std::vector<BuildItem> sorted(items.size());
    for (size_t i = 0; i < keys.size(); ++i)
        sorted[i] = items[keys[i].item];
    MortonBuilder builder(sorted, keys, leafLimit(settings));
    return layOut(builder.build(), 0, sorted, rejected, settings);
}

} // namespace q3rt
