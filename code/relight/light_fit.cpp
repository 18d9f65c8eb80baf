#include "relight/light_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace q3rt {
namespace {

/// Residuals beyond this many tolerances count linearly.
constexpr float kHuberLimit = 2;
constexpr int kMostSweeps = 60;
constexpr double kStill = 1e-3;
constexpr int kLocalSweeps = 6;

} // namespace

LightFit::LightFit(std::vector<FitTarget> targets)
    : m_targets(std::move(targets))
    , m_robust(m_targets.size()) {
    for (const FitTarget& target : m_targets)
        m_residual.push_back(target.light);
    reweigh();
}

size_t LightFit::add(LightColumn column, double price) {
    m_sources.push_back({std::move(column), vec3(0), std::numeric_limits<float>::infinity(), price});
    return m_sources.size() - 1;
}

void LightFit::removeLast() {
    setStrength(m_sources.size() - 1, vec3(0));
    m_sources.pop_back();
}

void LightFit::setStrength(size_t source, const vec3& strength) {
    Source& s = m_sources[source];
    const vec3 change = s.strength - strength;
    s.strength = strength;
    if (change == vec3(0)) return;
    for (size_t i = 0; i < s.column.receiver.size(); ++i)
        m_residual[s.column.receiver[i]] += change * s.column.value[i];
}

void LightFit::replaceColumn(size_t source, LightColumn column) {
    const vec3 strength = m_sources[source].strength;
    setStrength(source, vec3(0));
    m_sources[source].column = std::move(column);
    setStrength(source, strength);
}

void LightFit::setTargetLight(size_t patch, const vec3& light) {
    m_residual[patch] += light - m_targets[patch].light;
    m_targets[patch].light = light;
}

void LightFit::reweigh() {
    for (size_t i = 0; i < m_targets.size(); ++i) {
        const FitTarget& target = m_targets[i];
        const vec3 r = glm::abs(m_residual[i]);
        const float size = largestOf(r) / target.tolerance;
        m_robust[i] =
            target.weight / (target.tolerance * target.tolerance) * (size > kHuberLimit ? kHuberLimit / size : 1);
    }
}

vec3 LightFit::weightAt(size_t patch) const {
    const float weight = m_robust[patch];
    const FitTarget& target = m_targets[patch];
    if (!target.atLeast && !target.atMost) return vec3(weight);
    const vec3 wrong = target.atLeast ? m_residual[patch] : -m_residual[patch];
    return {wrong.x > 0 ? weight : 0, wrong.y > 0 ? weight : 0, wrong.z > 0 ? weight : 0};
}

LightFit::Slope LightFit::slopeOf(const LightColumn& column) const {
    Slope slope;
    for (size_t i = 0; i < column.receiver.size(); ++i) {
        const uint32_t at = column.receiver[i];
        const vec3 weighted = weightAt(at) * column.value[i];
        slope.gradient += dvec3(weighted * m_residual[at]);
        slope.square += dvec3(weighted * column.value[i]);
    }
    return slope;
}

vec3 LightFit::bestStrength(size_t source) const {
    const Source& s = m_sources[source];
    const Slope slope = slopeOf(s.column);
    vec3 strength = s.strength;
    for (int c = 0; c < 3; ++c)
        if (slope.square[c] > 0)
            strength[c] = std::clamp(strength[c] + static_cast<float>((slope.gradient[c] - s.price) / slope.square[c]),
                                     0.0f, s.limit);
    return strength;
}

double LightFit::gainOf(const LightColumn& column, double price) const {
    const Slope slope = slopeOf(column);
    double gain = 0;
    for (int c = 0; c < 3; ++c)
        if (const double g = slope.gradient[c] - price; slope.square[c] > 0 && g > 0) gain += g * g / slope.square[c];
    return gain;
}

double LightFit::sweep() {
    double moved = 0, all = 0;
    for (size_t k = 0; k < m_sources.size(); ++k) {
        const vec3 before = m_sources[k].strength, after = bestStrength(k);
        setStrength(k, after);
        const LightColumn& column = m_sources[k].column;
        double light = 0;
        for (size_t i = 0; i < column.receiver.size(); ++i)
            light += double(column.value[i]) * m_targets[column.receiver[i]].weight;
        const vec3 change = glm::abs(after - before);
        moved += light * (change.x + change.y + change.z);
        all += light * (after.x + after.y + after.z);
    }
    return all > 0 ? moved / all : 0;
}

void LightFit::settleAmong(const std::vector<size_t>& sources) {
    for (int round = 0; round < kLocalSweeps; ++round)
        for (const size_t source : sources)
            setStrength(source, bestStrength(source));
}

double LightFit::likeness(size_t a, size_t b) const {
    const LightColumn &x = m_sources[a].column, &y = m_sources[b].column;
    double both = 0, ofX = 0, ofY = 0;
    for (size_t i = 0; i < x.receiver.size(); ++i)
        ofX += double(m_robust[x.receiver[i]]) * x.value[i] * x.value[i];
    for (size_t k = 0; k < y.receiver.size(); ++k)
        ofY += double(m_robust[y.receiver[k]]) * y.value[k] * y.value[k];
    for (size_t i = 0, k = 0; i < x.receiver.size() && k < y.receiver.size();) {
        if (x.receiver[i] == y.receiver[k]) {
            both += double(m_robust[x.receiver[i]]) * x.value[i] * y.value[k];
            ++i, ++k;
        } else {
            x.receiver[i] < y.receiver[k] ? ++i : ++k;
        }
    }
    return both > 0 ? both / std::sqrt(ofX * ofY) : 0;
}

void LightFit::solve(int reweighings) {
    for (int round = 0; round < reweighings; ++round) {
        reweigh();
        for (int i = 0; i < kMostSweeps; ++i)
            if (sweep() < kStill) break;
    }
    reweigh();
}

double LightFit::cost() const {
    double sum = 0;
    for (const Source& s : m_sources)
        sum += 2 * s.price * (double(s.strength.x) + s.strength.y + s.strength.z);
    for (size_t i = 0; i < m_targets.size(); ++i)
        sum += double(glm::dot(weightAt(i) * m_residual[i], m_residual[i]));
    return sum;
}

} // namespace q3rt
