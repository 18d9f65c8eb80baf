#include "renderer_rt/blue_noise/void_and_cluster.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace q3rt {

namespace {

/// Width of the Gaussian by which points feel each other, texels: the value of the paper's section 4.
constexpr double kSigma = 1.5;
/// Part of the points that the first pattern has.
constexpr uint32_t kFirstShare = 10;

class Pattern {
  public:
    explicit Pattern(uint32_t side)
        : m_side(side)
        , m_points(size_t{side} * side, 0)
        , m_energy(size_t{side} * side, 0.0)
        , m_falloff(size_t{side} * side) {
        for (uint32_t i = 0; i < m_falloff.size(); ++i) {
            const double x = wrapped(i % side), y = wrapped(i / side);
            m_falloff[i] = std::exp(-(x * x + y * y) / (2 * kSigma * kSigma));
        }
    }
    void set(size_t at, bool point) {
        m_points[at] = point;
        const double sign = point ? 1 : -1;
        const size_t x0 = at % m_side, y0 = at / m_side;
        for (size_t y = 0; y < m_side; ++y) {
            const size_t row = (y + m_side - y0) % m_side * m_side;
            for (size_t x = 0; x < m_side; ++x)
                m_energy[y * m_side + x] += sign * m_falloff[row + (x + m_side - x0) % m_side];
        }
    }
    size_t tightestCluster() const { return extreme(true); }
    size_t largestVoid() const { return extreme(false); }

  private:
    double wrapped(uint32_t distance) const { return std::min(distance, m_side - distance); }
    /// The point that others press most, or the empty place that they press least.
    size_t extreme(bool point) const {
        size_t best = m_points.size();
        for (size_t i = 0; i < m_points.size(); ++i) {
            if ((m_points[i] != 0) != point) continue;
            if (best == m_points.size() || (point ? m_energy[i] > m_energy[best] : m_energy[i] < m_energy[best]))
                best = i;
        }
        return best;
    }

    uint32_t m_side;
    std::vector<char> m_points;
    std::vector<double> m_energy, m_falloff;
};

/// Points at random, then moved from clusters to voids until that changes nothing. Returns how many.
uint32_t makeFirstPattern(Pattern& pattern, uint32_t count, uint32_t seed) {
    std::vector<uint32_t> places(count);
    std::iota(places.begin(), places.end(), 0u);
    std::mt19937 random(seed);
    for (uint32_t i = 0; i < count / kFirstShare; ++i) { // the first of a shuffle: the same with any library
        std::swap(places[i], places[i + random() % (count - i)]);
        pattern.set(places[i], true);
    }
    for (;;) {
        const size_t cluster = pattern.tightestCluster();
        pattern.set(cluster, false);
        const size_t empty = pattern.largestVoid();
        pattern.set(empty, true);
        if (empty == cluster) return count / kFirstShare;
    }
}

} // namespace

std::vector<uint16_t> makeBlueNoise(uint32_t side, uint32_t seed) {
    const uint32_t count = side * side;
    Pattern first(side);
    const uint32_t firstCount = makeFirstPattern(first, count, seed);
    std::vector<uint16_t> ranks(count);
    Pattern shrinking = first;
    for (uint32_t rank = firstCount; rank-- > 0;) {
        const size_t at = shrinking.tightestCluster();
        shrinking.set(at, false);
        ranks[at] = static_cast<uint16_t>(rank);
    }
    // On a torus the empty place that points press least is also the tightest cluster of empty places: the paper's
    // phases 2 and 3 are one.
    for (uint32_t rank = firstCount; rank < count; ++rank) {
        const size_t at = first.largestVoid();
        first.set(at, true);
        ranks[at] = static_cast<uint16_t>(rank);
    }
    return ranks;
}

} // namespace q3rt
