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
/// A strength is found when a step moves it by less than this share.
constexpr float kFound = 1e-3f;
constexpr int kMostSteps = 16;

bool countsOneSide(const FitTarget& target) { return target.atLeast || target.atMost; }

/// What of a residual counts.
vec3 wrongOf(const FitTarget& target, const vec3& residual) {
    return target.atLeast ? glm::max(residual, 0.0f) : target.atMost ? glm::min(residual, 0.0f) : residual;
}

/// The zero of a slope that falls steadily with strength, by Newton's steps. Patches that count on one side only start
/// or cease to count on the way, so a step may go too far; but every slope tells on which side of it the zero lies.
class ZeroSearch {
  public:
    /// `square`: by how much the slope falls per unit of strength, here.
    float next(float strength, double slope, double square) {
        if (slope == 0) return strength;
        (slope > 0 ? m_low : m_high) = strength;
        const float step = square > 0 ? strength + static_cast<float>(slope / square) : 0;
        if (step > m_low && step < m_high) return step;
        const float middle = 0.5f * (m_low + m_high);
        return std::isfinite(middle) ? middle : strength;
    }

  private:
    float m_low = -std::numeric_limits<float>::infinity(), m_high = std::numeric_limits<float>::infinity();
};

} // namespace

LightFit::LightFit(std::vector<FitTarget> targets)
    : m_targets(std::move(targets))
    , m_robust(m_targets.size()) {
    for (const FitTarget& target : m_targets)
        m_residual.push_back(target.light);
    reweigh();
}

size_t LightFit::add(LightColumn column, double price) {
    m_sources.push_back({{}, vec3(0), std::numeric_limits<float>::infinity(), price, false});
    replaceColumn(m_sources.size() - 1, std::move(column));
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
    Source& s = m_sources[source];
    s.column = std::move(column);
    s.meetsOneSided = std::any_of(s.column.receiver.begin(), s.column.receiver.end(),
                                  [this](uint32_t at) { return countsOneSide(m_targets[at]); });
    setStrength(source, strength);
}

void LightFit::setTargetLight(size_t patch, const vec3& light) {
    m_residual[patch] += light - m_targets[patch].light;
    m_targets[patch].light = light;
}

void LightFit::reweigh() {
    for (size_t i = 0; i < m_targets.size(); ++i) {
        const FitTarget& target = m_targets[i];
        const float size = largestOf(glm::abs(wrongOf(target, m_residual[i]))) / target.tolerance;
        m_robust[i] =
            target.weight / (target.tolerance * target.tolerance) * (size > kHuberLimit ? kHuberLimit / size : 1);
    }
}

vec3 LightFit::weightAt(size_t patch) const { return weightAt(patch, m_residual[patch]); }

vec3 LightFit::weightAt(size_t patch, const vec3& residual) const {
    const float weight = m_robust[patch];
    if (!countsOneSide(m_targets[patch])) return vec3(weight);
    const vec3 wrong = wrongOf(m_targets[patch], residual);
    return {wrong.x != 0 ? weight : 0, wrong.y != 0 ? weight : 0, wrong.z != 0 ? weight : 0};
}

LightFit::Slope LightFit::slopeOf(const LightColumn& column, const vec3& more) const {
    Slope slope;
    for (size_t i = 0; i < column.receiver.size(); ++i) {
        const uint32_t at = column.receiver[i];
        const vec3 residual = m_residual[at] - more * column.value[i];
        const vec3 weighted = weightAt(at, residual) * column.value[i];
        slope.gradient += dvec3(weighted * residual);
        slope.square += dvec3(weighted * column.value[i]);
    }
    return slope;
}

vec3 LightFit::bestStrength(size_t source) const {
    const Source& s = m_sources[source];
    vec3 best = s.strength;
    if (s.column.receiver.empty()) return best;
    ZeroSearch search[3];
    for (int step = 0; step < kMostSteps; ++step) {
        const Slope slope = slopeOf(s.column, best - s.strength);
        const vec3 before = best;
        for (int c = 0; c < 3; ++c)
            best[c] = std::clamp(search[c].next(best[c], slope.gradient[c] - s.price, slope.square[c]), 0.0f, s.limit);
        if (!s.meetsOneSided || largestOf(glm::abs(best - before) - kFound * best) <= 0) break;
    }
    return best;
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
