#pragma once
// How well traced light agrees with baked light.

#include <cstddef>
#include <utility>
#include <vector>

namespace q3rt {

/// Luxel units of the largest channel, as the map has them.
struct LightScore {
    double correlation = 0;         ///< Pearson; 0 where either is constant
    double medianRelativeError = 0; ///< |traced - baked| / baked, which is at least one byte step
    double explainedShare = 0;      ///< sum of min(traced, baked) / sum of baked
    double meanTraced = 0, meanBaked = 0;
    size_t count = 0;
};

class ScoreSum {
  public:
    void add(double traced, double baked, double weight);
    LightScore result() const;

  private:
    double m_weight = 0, m_t = 0, m_b = 0, m_tt = 0, m_bb = 0, m_tb = 0, m_least = 0;
    std::vector<std::pair<double, double>> m_errors; ///< with their weights
};

} // namespace q3rt
