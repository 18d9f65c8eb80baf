#include "relight/light_score.hpp"

#include <algorithm>
#include <cmath>

namespace q3rt {

void ScoreSum::add(double traced, double baked, double weight) {
    m_weight += weight;
    m_t += weight * traced;
    m_b += weight * baked;
    m_tt += weight * traced * traced;
    m_bb += weight * baked * baked;
    m_tb += weight * traced * baked;
    m_least += weight * std::min(traced, baked);
    m_errors.emplace_back(std::abs(traced - baked) / std::max(1.0, baked), weight);
}

LightScore ScoreSum::result() const {
    LightScore score;
    score.count = m_errors.size();
    if (!(m_weight > 0)) return score;
    score.meanTraced = m_t / m_weight;
    score.meanBaked = m_b / m_weight;
    score.explainedShare = m_b > 0 ? m_least / m_b : 0;
    const double varianceT = m_tt / m_weight - score.meanTraced * score.meanTraced,
                 varianceB = m_bb / m_weight - score.meanBaked * score.meanBaked;
    if (varianceT > 0 && varianceB > 0)
        score.correlation = (m_tb / m_weight - score.meanTraced * score.meanBaked) / std::sqrt(varianceT * varianceB);
    std::vector<std::pair<double, double>> errors = m_errors;
    std::sort(errors.begin(), errors.end());
    double sum = 0;
    for (const auto& [error, weight] : errors) {
        sum += weight;
        score.medianRelativeError = error;
        if (sum >= m_weight / 2) break;
    }
    return score;
}

} // namespace q3rt
