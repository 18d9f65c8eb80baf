#include "relight/point_search.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "relight/lost_units.hpp"
#include "relight/point_move.hpp"

namespace q3rt {
namespace {

constexpr int kClimbRays = 128;
/// Eyes looked at in one round, far enough apart not to explain the same light; patches that lack most light, and how
/// far in front of them lamps are tried; and how many of all these are followed up.
constexpr size_t kEyes = 6, kPeaks = 4, kClimbs = 6;
constexpr float kApartQu = 128;
constexpr float kPeakHeightsQu[] = {8, 24, 64};
/// Climbing steps, halved from the first to the last, qu.
constexpr float kFirstStepQu = 32, kLastStepQu = 4;
constexpr int kMovesPerStep = 3;
/// A candidate whose traced light gains less of what its eye promised is no light.
constexpr double kKeptPromise = 0.1;
constexpr int kRestRounds = 30;
/// Lights this near to each other may be two halves of one, qu.
constexpr float kMergeQu = 64;
/// Lights that light the same places, at least this much alike, may take over from each other (cosine).
constexpr double kHeirLikeness = 0.2;
/// A light's reach follows its strength where that has changed by more than this factor.
constexpr float kReachSlack = 1.1f;
/// So many rounds without a light end the search.
constexpr int kIdleRounds = 12;

float faintestOf(const vec3& intensity) { return kFaintestLight / std::max(1.0f, largestOf(intensity)); }

} // namespace

PointSearch::PointSearch(const LightScene& scene, const std::vector<LightEye>& eyes, LightFit& fit, double price)
    : m_scene(scene)
    , m_eyes(eyes)
    , m_fit(fit)
    , m_price(price)
    , m_restUntil(eyes.size() + scene.luxels.patches.size(), 0) {}

void PointSearch::addKnown(const vec3& origin, const LightCone& cone, const vec3& intensity, bool staysPut) {
    LightColumn column = tracePoint(m_scene, m_scene.receivers, origin, faintestOf(intensity));
    const size_t source = m_fit.add(withinCone(m_scene.receivers, origin, cone, column), staysPut ? 0 : m_price);
    m_fit.setStrength(source, intensity);
    m_lights.push_back({origin, cone, source, staysPut, std::move(column), faintestOf(intensity)});
}

LightEye::Worth PointSearch::worthAt(const vec3& origin, const SeenResidual& seen) const {
    if (m_scene.world.clusterOf(origin) < 0) return {};
    // The same directions everywhere: a climb compares places, not luck.
    return LightEye(m_scene, origin, kClimbRays, 0).worth(seen);
}

void PointSearch::addEyes(const SeenResidual& seen, double leastGain, std::vector<Candidate>& candidates) const {
    std::vector<double> gains(m_eyes.size(), 0);
    parallelFor(m_eyes.size(), [&](size_t i) {
        if (m_restUntil[i] <= m_round) gains[i] = m_eyes[i].worth(seen).gain;
    });
    std::vector<size_t> order(m_eyes.size());
    for (size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return gains[a] > gains[b]; });
    for (const size_t eye : order) {
        if (candidates.size() == kEyes || gains[eye] < leastGain) break;
        const vec3& origin = m_eyes[eye].origin();
        if (std::none_of(candidates.begin(), candidates.end(),
                         [&](const Candidate& other) { return glm::length(other.origin - origin) < kApartQu; }))
            candidates.push_back({origin, eye});
    }
}

/// Lamps close to a surface fall between the eyes: places in front of the patches that lack most light.
void PointSearch::addPeaks(std::vector<Candidate>& candidates) const {
    std::vector<std::pair<float, size_t>> lacks;
    for (size_t i = 0; i < m_scene.luxels.patches.size(); ++i) {
        if (m_restUntil[m_eyes.size() + i] > m_round) continue;
        const vec3 r = m_fit.residual()[i];
        const float lack = largestOf(m_fit.weightAt(i) * r * glm::max(r, 0.0f));
        if (lack > 0) lacks.emplace_back(-lack, i);
    }
    const size_t count = std::min(kPeaks, lacks.size());
    std::partial_sort(lacks.begin(), lacks.begin() + static_cast<std::ptrdiff_t>(count), lacks.end());
    for (size_t i = 0; i < count; ++i) {
        const LuxelPatch& patch = m_scene.luxels.patches[lacks[i].second];
        for (const float height : kPeakHeightsQu)
            candidates.push_back({patch.position + height * patch.normal, m_eyes.size() + lacks[i].second});
    }
}

std::vector<PointSearch::Candidate> PointSearch::findCandidates(const SeenResidual& seen, double leastGain) const {
    std::vector<Candidate> all;
    addEyes(seen, leastGain, all);
    addPeaks(all);
    parallelFor(all.size(), [&](size_t i) { all[i].gain = worthAt(all[i].origin, seen).gain; });
    const auto isBetter = [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; };
    std::stable_sort(all.begin(), all.end(), isBetter);
    std::vector<Candidate> chosen;
    for (const Candidate& candidate : all) // those in front of one patch stand for one light
        if (chosen.size() < kClimbs && std::none_of(chosen.begin(), chosen.end(), [&](const Candidate& other) {
                return other.place == candidate.place;
            }))
            chosen.push_back(candidate);
    parallelFor(chosen.size(), [&](size_t i) { climb(chosen[i], seen); });
    std::stable_sort(chosen.begin(), chosen.end(), isBetter);
    return chosen;
}

void PointSearch::climb(Candidate& candidate, const SeenResidual& seen) const {
    for (float step = kFirstStepQu; step >= kLastStepQu; step /= 2) {
        bool moved = true;
        for (int i = 0; i < kMovesPerStep && moved; ++i) {
            moved = false;
            for (int side = 0; side < 6; ++side) {
                vec3 next = candidate.origin;
                next[side / 2] += side % 2 ? step : -step;
                const double gain = worthAt(next, seen).gain;
                if (gain <= candidate.gain) continue;
                candidate.origin = next;
                candidate.gain = gain;
                moved = true;
            }
        }
    }
    const LightEye::Worth worth = worthAt(candidate.origin, seen);
    candidate.faintest = faintestOf(worth.strength);
    candidate.column = tracePoint(m_scene, m_scene.receivers, candidate.origin, candidate.faintest);
    if (worth.axis == vec3(0)) return;
    const FittedCone fitted = fitCone(m_scene, m_fit, candidate.origin, candidate.column, worth.axis, m_price);
    if (fitted.gain > kSpotHandicap * m_fit.gainOf(candidate.column, m_price)) candidate.cone = fitted.cone;
}

bool PointSearch::take(Candidate& candidate, double leastGain) {
    const double cost = m_fit.cost();
    const size_t source =
        m_fit.add(withinCone(m_scene.receivers, candidate.origin, candidate.cone, candidate.column), m_price);
    m_fit.setStrength(source, m_fit.bestStrength(source));
    const double gain = cost - m_fit.cost();
    // Another one of the round may have explained the same light already.
    if (gain < kKeptPromise * candidate.gain || gain < leastGain) {
        m_fit.removeLast();
        return false;
    }
    m_lights.push_back(
        {candidate.origin, candidate.cone, source, false, std::move(candidate.column), candidate.faintest});
    return true;
}

void PointSearch::rest(size_t place) {
    if (place >= m_eyes.size()) {
        m_restUntil[place] = m_round + kRestRounds;
        return;
    }
    for (size_t i = 0; i < m_eyes.size(); ++i)
        if (glm::length(m_eyes[i].origin() - m_eyes[place].origin()) < 0.5f * kApartQu)
            m_restUntil[i] = m_round + kRestRounds;
}

void PointSearch::add(size_t count, double leastGain, const std::function<void(size_t)>& found) {
    size_t added = 0;
    for (int idle = 0; added < count && idle < kIdleRounds; ++idle, ++m_round) {
        const SeenResidual seen(m_fit, m_scene.luxels, m_price);
        const double least = leastGain * m_fit.cost();
        std::vector<Candidate> candidates = findCandidates(seen, least);
        if (candidates.empty()) break;
        for (Candidate& candidate : candidates) {
            if (added == count) break;
            if (take(candidate, least)) {
                ++added;
                idle = -1;
            } else {
                rest(candidate.place);
            }
        }
        m_fit.sweep();
        found(added);
    }
}

void PointSearch::retrace() {
    std::vector<LightColumn> columns(m_lights.size());
    const auto isStale = [&](const FoundLight& light) {
        const float ratio = faintestOf(m_fit.strength(light.source)) / light.faintest;
        return ratio > kReachSlack || ratio < 1 / kReachSlack;
    };
    parallelFor(m_lights.size(), [&](size_t i) {
        if (isStale(m_lights[i]))
            columns[i] = tracePoint(m_scene, m_scene.receivers, m_lights[i].origin,
                                    faintestOf(m_fit.strength(m_lights[i].source)));
    });
    for (size_t i = 0; i < m_lights.size(); ++i) {
        FoundLight& light = m_lights[i];
        if (!isStale(light)) continue;
        light.faintest = faintestOf(m_fit.strength(light.source));
        light.column = std::move(columns[i]);
        m_fit.replaceColumn(light.source, withinCone(m_scene.receivers, light.origin, light.cone, light.column));
    }
}

void PointSearch::refinePlaces() {
    std::vector<vec3> places(m_lights.size());
    std::vector<LightColumn> columns(m_lights.size());
    parallelFor(m_lights.size(), [&](size_t i) {
        const FoundLight& light = m_lights[i];
        places[i] = light.origin;
        if (light.staysPut) return;
        places[i] += moveOf(m_scene, m_fit, light);
        if (places[i] != light.origin)
            columns[i] = tracePoint(m_scene, m_scene.receivers, places[i], faintestOf(m_fit.strength(light.source)));
    });
    for (size_t i = 0; i < m_lights.size(); ++i) {
        FoundLight& light = m_lights[i];
        if (places[i] == light.origin) continue;
        LightColumn old = m_fit.column(light.source);
        const vec3 strength = m_fit.strength(light.source);
        const double cost = m_fit.cost();
        m_fit.replaceColumn(light.source, withinCone(m_scene.receivers, places[i], light.cone, columns[i]));
        m_fit.setStrength(light.source, m_fit.bestStrength(light.source));
        if (m_fit.cost() < cost) {
            light.origin = places[i];
            light.column = std::move(columns[i]);
            light.faintest = faintestOf(strength);
        } else {
            m_fit.replaceColumn(light.source, std::move(old));
            m_fit.setStrength(light.source, strength);
        }
    }
}

/// Where most of the light goes that only this light explains.
vec3 PointSearch::axisOf(const FoundLight& light) const {
    if (!light.cone.isPoint()) return light.cone.axis;
    vec3 mean(0);
    for (size_t i = 0; i < light.column.receiver.size(); ++i) {
        const uint32_t at = light.column.receiver[i];
        const vec3 way = m_scene.receivers[at].position[0] - light.origin,
                   r = m_fit.weightAt(at) * m_fit.residual()[at];
        if (const float length = glm::length(way); length > 0)
            mean += (r.x + r.y + r.z) * light.column.value[i] / length * way;
    }
    const float length = glm::length(mean);
    return length > 0 ? mean / length : vec3(0);
}

void PointSearch::refineCones() {
    for (FoundLight& light : m_lights) {
        if (light.staysPut) continue;
        const vec3 strength = m_fit.strength(light.source);
        m_fit.setStrength(light.source, vec3(0));
        FittedCone fitted;
        if (const vec3 axis = axisOf(light); axis != vec3(0))
            fitted = fitCone(m_scene, m_fit, light.origin, light.column, axis, m_price);
        if (fitted.gain < kSpotHandicap * m_fit.gainOf(light.column, m_price)) fitted.cone = {};
        if (fitted.cone.axis == light.cone.axis && fitted.cone.radius == light.cone.radius) {
            m_fit.setStrength(light.source, strength);
            continue;
        }
        light.cone = fitted.cone;
        m_fit.replaceColumn(light.source, withinCone(m_scene.receivers, light.origin, light.cone, light.column));
        m_fit.setStrength(light.source, m_fit.bestStrength(light.source));
    }
}

bool PointSearch::isTakenOver(size_t source, const std::vector<size_t>& heirs, double cost, double leastGain) {
    std::vector<vec3> before;
    for (const size_t heir : heirs)
        before.push_back(m_fit.strength(heir));
    const vec3 strength = m_fit.strength(source);
    m_fit.setStrength(source, vec3(0));
    m_fit.settleAmong(heirs);
    if (m_fit.cost() - cost < leastGain * cost) return true;
    for (size_t i = 0; i < heirs.size(); ++i)
        m_fit.setStrength(heirs[i], before[i]);
    m_fit.setStrength(source, strength);
    return false;
}

std::vector<size_t> PointSearch::heirsOf(size_t source) const {
    std::vector<size_t> heirs;
    for (size_t other = 0; other < m_fit.sourceCount(); ++other)
        if (other != source && m_fit.likeness(other, source) > kHeirLikeness) heirs.push_back(other);
    return heirs;
}

bool PointSearch::mergeInto(FoundLight& light, const FoundLight& other, double leastGain) {
    const double cost = m_fit.cost();
    const float a = largestOf(m_fit.strength(light.source)), b = largestOf(m_fit.strength(other.source));
    const vec3 place = glm::mix(light.origin, other.origin, b / (a + b));
    if (m_scene.world.clusterOf(place) < 0) return false;
    const float faintest = faintestOf(m_fit.strength(light.source) + m_fit.strength(other.source));
    LightColumn column = tracePoint(m_scene, m_scene.receivers, place, faintest), old = m_fit.column(light.source);
    m_fit.replaceColumn(light.source, withinCone(m_scene.receivers, place, light.cone, column));
    if (isTakenOver(other.source, heirsOf(other.source), cost, leastGain)) {
        light.origin = place;
        light.column = std::move(column);
        light.faintest = faintest;
        return true;
    }
    m_fit.replaceColumn(light.source, std::move(old));
    return false;
}

void PointSearch::prune(double leastGain) {
    // The strongest first: far lights that stand in for near ones are stronger than those.
    std::stable_sort(m_lights.begin(), m_lights.end(), [&](const FoundLight& a, const FoundLight& b) {
        return largestOf(m_fit.strength(a.source)) > largestOf(m_fit.strength(b.source));
    });
    for (size_t i = 0; i < m_lights.size(); ++i)
        for (size_t k = i + 1; k < m_lights.size(); ++k) {
            FoundLight &light = m_lights[i], &other = m_lights[k];
            if (light.staysPut || other.staysPut || glm::length(light.origin - other.origin) > kMergeQu ||
                light.cone.isPoint() != other.cone.isPoint() || m_fit.strength(other.source) == vec3(0))
                continue;
            mergeInto(light, other, leastGain);
        }
    std::erase_if(m_lights, [&](const FoundLight& light) {
        const bool isDark = m_fit.strength(light.source) == vec3(0);
        const auto isSpare = [&] {
            return !light.staysPut && isTakenOver(light.source, heirsOf(light.source), m_fit.cost(), leastGain);
        };
        if (!isDark && !isSpare()) return false;
        m_fit.replaceColumn(light.source, {});
        return true;
    });
}

void PointSearch::addLightAt(const std::vector<LightReceiver>& receivers, std::vector<vec3>& irradiance) const {
    std::vector<LightColumn> columns(m_lights.size());
    parallelFor(m_lights.size(), [&](size_t i) {
        const FoundLight& light = m_lights[i];
        columns[i] = withinCone(receivers, light.origin, light.cone,
                                tracePoint(m_scene, receivers, light.origin, faintestOf(m_fit.strength(light.source))));
    });
    for (size_t i = 0; i < m_lights.size(); ++i)
        for (size_t k = 0; k < columns[i].receiver.size(); ++k)
            irradiance[columns[i].receiver[k]] += columns[i].value[k] * m_fit.strength(m_lights[i].source);
}

} // namespace q3rt
