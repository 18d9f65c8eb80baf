// A binned SAH build that keeps nothing but the order of its leaves. Ingo Wald, "On fast Construction of SAH-based
// Bounding Volume Hierarchies" (2007), the binning of section 3; splits of primitive centres only.

#include "scene/triangle_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace q3rt {
namespace {

constexpr int kBinCount = 16;     // more gains below 1 % in tree cost
constexpr uint32_t kLeafSize = 2; // order inside smaller sets doesn't matter
constexpr int kMaxSahDepth = 64;  // beyond it sets are halved: bounds the recursion on adversarial input

struct Primitive {
    Bounds bounds;
    vec3 centre{0};
};

struct Bin {
    Bounds bounds;
    uint32_t count = 0;
};

struct Split {
    int axis = -1; ///< -1: no split separates the centres
    int bin = 0;   ///< bins up to this one go left
    float cost = std::numeric_limits<float>::max();
};

float halfArea(const Bounds& box) {
    if (box.empty()) return 0.0f;
    const vec3 d = box.maxs - box.mins;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

bool isFinite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

class Orderer {
  public:
    explicit Orderer(std::span<const vec3> corners) {
        const size_t count = corners.size() / 3;
        m_primitives.resize(count);
        for (size_t i = 0; i < count; ++i) {
            Primitive& primitive = m_primitives[i];
            for (size_t k = 0; k < 3; ++k) {
                const vec3& corner = corners[3 * i + k];
                primitive.bounds.add(isFinite(corner) ? corner : vec3(0.0f));
            }
            primitive.centre = primitive.bounds.mins * 0.5f + primitive.bounds.maxs * 0.5f;
        }
        m_order.resize(count);
        std::iota(m_order.begin(), m_order.end(), 0u);
    }

    std::vector<uint32_t> run() {
        struct Range {
            uint32_t first, count;
            int depth;
        };
        std::vector<Range> open{{0, static_cast<uint32_t>(m_order.size()), 0}};
        while (!open.empty()) {
            const Range range = open.back();
            open.pop_back();
            if (range.count <= kLeafSize) continue;
            const uint32_t left = partition(range.first, range.count, range.depth);
            open.push_back({range.first + left, range.count - left, range.depth + 1});
            open.push_back({range.first, left, range.depth + 1});
        }
        return std::move(m_order);
    }

  private:
    std::vector<Primitive> m_primitives;
    std::vector<uint32_t> m_order;

    /// Bin of a centre along one axis; `scale` maps the centres' extent to the bins.
    static int binOf(const vec3& centre, const Bounds& centres, int axis, float scale) {
        return std::min(kBinCount - 1, static_cast<int>((centre[axis] - centres.mins[axis]) * scale));
    }

    static float binScale(const Bounds& centres, int axis) {
        const float extent = centres.maxs[axis] - centres.mins[axis];
        const float scale = static_cast<float>(kBinCount) / extent;
        return extent > 0.0f && std::isfinite(scale) && std::isfinite(extent) ? scale : 0.0f;
    }

    static void findBestBin(const std::array<Bin, kBinCount>& bins, int axis, Split& best) {
        std::array<float, kBinCount> rightCost{};
        Bounds right;
        uint32_t count = 0;
        for (size_t i = kBinCount - 1; i > 0; --i) {
            right.add(bins[i].bounds);
            count += bins[i].count;
            rightCost[i - 1] = count == 0 ? -1.0f : halfArea(right) * static_cast<float>(count);
        }
        Bounds left;
        count = 0;
        for (size_t i = 0; i + 1 < kBinCount; ++i) {
            left.add(bins[i].bounds);
            count += bins[i].count;
            if (count == 0 || rightCost[i] < 0.0f) continue;
            const float cost = halfArea(left) * static_cast<float>(count) + rightCost[i];
            if (cost < best.cost || best.axis < 0) best = {axis, static_cast<int>(i), cost};
        }
    }

    /// Orders a range so that its first part is the left child; returns that part's size, in [1, count - 1].
    uint32_t partition(uint32_t first, uint32_t count, int depth) {
        const auto begin = m_order.begin() + first, end = begin + count;
        Bounds centres;
        for (auto it = begin; it != end; ++it) {
            centres.add(m_primitives[*it].centre);
        }
        Split best;
        for (int axis = 0; axis < 3 && depth < kMaxSahDepth; ++axis) {
            const float scale = binScale(centres, axis);
            if (scale == 0.0f) continue;
            std::array<Bin, kBinCount> bins;
            for (auto it = begin; it != end; ++it) {
                Bin& bin = bins[static_cast<size_t>(binOf(m_primitives[*it].centre, centres, axis, scale))];
                bin.bounds.add(m_primitives[*it].bounds);
                ++bin.count;
            }
            findBestBin(bins, axis, best);
        }
        if (best.axis < 0) return count / 2; // all centres coincide
        const float scale = binScale(centres, best.axis);
        const auto middle = std::stable_partition(begin, end, [&](uint32_t i) {
            return binOf(m_primitives[i].centre, centres, best.axis, scale) <= best.bin;
        });
        return static_cast<uint32_t>(middle - begin);
    }
};

} // namespace

std::vector<uint32_t> sahLeafOrder(std::span<const vec3> trianglePositions) { return Orderer(trianglePositions).run(); }

} // namespace q3rt
