#include "relight/relight_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "relight/lost_units.hpp"
#include "relight/sun_search.hpp"

namespace q3rt {
namespace {

/// A bounce dies out with the mean albedo: after so many what is left is below a byte step.
constexpr int kBounces = 6;
/// What bounces may give at most, over what physics has.
constexpr double kLargestBounceScale = 1.5;
/// Saturated places do not bounce without limit, luxel units.
constexpr float kBrightestBounce = 1000;
constexpr int kRefinements = 2;
constexpr size_t kMostSuns = 4;
/// Of a sun that is worth keeping, luxel units.
constexpr float kFaintestSun = 0.5f;

} // namespace

RelightModel::RelightModel(const RelightInput& input, const LostLights& lights)
    : m_input(input)
    , m_fit(input.makeTargets())
    , m_faintestSurface(lights.faintestSurface)
    , m_bounced(input.scene.receivers.size(), vec3(0))
    , m_bounceScale(lights.bounce) {
    addKinds(lights);
    for (const SunLight& sun : lights.suns)
        addSun(sun);
    m_points = std::make_unique<PointSearch>(input.scene, input.eyes, m_fit, input.price);
    for (const PointLight& light : lights.points) {
        LightCone cone;
        if (light.spot) cone = {light.direction, light.tangent()};
        const bool isKnown = std::any_of(input.scene.lights.points.begin(), input.scene.lights.points.end(),
                                         [&](const PointLight& known) { return known.origin == light.origin; });
        m_points->addKnown(light.origin, cone, light.intensity, isKnown);
    }
    m_fit.reweigh();
    std::vector<vec3> lit = direct();
    for (int i = 0; i < kBounces; ++i) {
        setBounced(bouncesOf(lit), m_bounceScale);
        lit = direct();
        for (size_t p = 0; p < lit.size(); ++p)
            lit[p] += static_cast<float>(m_bounceScale) * m_bounced[p];
    }
    m_fit.reweigh();
}

void RelightModel::addKinds(const LostLights& lights) {
    std::map<std::pair<bool, std::string>, vec3> radiosities;
    for (const LostLights::Strength& s : lights.surfaceLights)
        radiosities[{false, s.material}] = s.color * (s.value * radiosityOfValue(EmitterKind::Type::Surface));
    for (const LostLights::Strength& s : lights.skyLights)
        radiosities[{true, s.material}] = s.color * (s.value * radiosityOfValue(EmitterKind::Type::SkyDome));
    std::vector<vec3> ofKinds;
    std::vector<float> largest;
    for (const EmitterKind& kind : m_input.scene.kinds) {
        ofKinds.push_back(radiosities[{kind.type == EmitterKind::Type::SkyDome, kind.material}]);
        largest.push_back(largestOf(ofKinds.back()));
    }
    std::vector<LightColumn> columns = m_input.kindColumnsOf(largest, m_faintestSurface);
    for (size_t k = 0; k < columns.size(); ++k) {
        m_kindSources.push_back(m_fit.add(std::move(columns[k])));
        m_fit.setStrength(m_kindSources.back(), ofKinds[k]);
    }
    LightColumn everywhere;
    for (size_t i = 0; i < m_input.scene.receivers.size(); ++i)
        everywhere.append(i, 1);
    m_ambientSource = m_fit.add(std::move(everywhere));
    m_fit.setLimit(m_ambientSource, m_input.ambientLimit);
    m_fit.setStrength(m_ambientSource, lights.ambientColor * lights.ambientValue);
}

void RelightModel::addSun(const SunLight& sun) {
    const size_t source = m_fit.add(traceSun(m_input.scene, m_input.scene.receivers, sun));
    m_fit.setStrength(source, sun.irradiance);
    m_suns.push_back({sun, source});
}

std::vector<vec3> RelightModel::direct() const {
    std::vector<vec3> lit(m_fit.residual().size());
    for (size_t i = 0; i < lit.size(); ++i)
        lit[i] = m_fit.targets()[i].light - m_fit.residual()[i];
    return lit;
}

std::vector<vec3> RelightModel::bouncesOf(const std::vector<vec3>& irradiance) const {
    std::vector<vec3> radiosity(irradiance.size());
    for (size_t i = 0; i < radiosity.size(); ++i)
        radiosity[i] = m_input.scene.luxels.patches[i].albedo * glm::min(irradiance[i], vec3(kBrightestBounce));
    return m_input.rays.gather(radiosity);
}

void RelightModel::setBounced(std::vector<vec3> bounced, double scale) {
    m_bounced = std::move(bounced);
    m_bounceScale = scale;
    for (size_t i = 0; i < m_bounced.size(); ++i)
        m_fit.setTargetLight(i, m_input.bakedIrradiance(i) - static_cast<float>(scale) * m_bounced[i]);
}

/// The scale at which bounces explain most of what direct light leaves.
double RelightModel::bestBounceScale() const {
    double gradient = 0, square = 0;
    for (size_t i = 0; i < m_bounced.size(); ++i) {
        const vec3 weight = m_fit.weightAt(i);
        const vec3 left = m_fit.residual()[i] + static_cast<float>(m_bounceScale) * m_bounced[i];
        gradient += double(glm::dot(weight * left, m_bounced[i]));
        square += double(glm::dot(weight * m_bounced[i], m_bounced[i]));
    }
    return square > 0 ? std::clamp(gradient / square, 0.0, kLargestBounceScale) : 0;
}

void RelightModel::solveFirst() {
    std::vector<vec3> baked;
    for (size_t i = 0; i < m_bounced.size(); ++i)
        baked.push_back(m_input.bakedIrradiance(i));
    setBounced(bouncesOf(baked), m_bounceScale);
    m_fit.solve(2);
}

void RelightModel::addSuns() {
    while (m_suns.size() < kMostSuns) {
        const auto direction = findSun(m_input.scene, m_fit, m_input.settings.leastSunGain);
        if (!direction) return;
        const double cost = m_fit.cost();
        addSun({*direction, vec3(0), 0});
        const size_t source = m_suns.back().source;
        m_fit.setStrength(source, m_fit.bestStrength(source));
        if (cost - m_fit.cost() < m_input.settings.leastSunGain * cost) {
            m_fit.removeLast();
            m_suns.pop_back();
            return;
        }
        m_fit.solve(1);
    }
}

void RelightModel::addPoints(size_t count, const std::function<void(size_t)>& found) {
    m_points->add(count, m_input.settings.leastGain, found);
}

void RelightModel::settle() {
    m_fit.solve(2);
    for (int i = 0; i < kRefinements; ++i) {
        m_points->retrace();
        m_points->refinePlaces();
        m_fit.sweep();
    }
    m_points->refineCones();
    m_fit.sweep();
    m_points->prune(0.5 * m_input.settings.leastGain);
    m_fit.solve(2);
    std::vector<vec3> lit = direct();
    for (size_t i = 0; i < lit.size(); ++i)
        lit[i] += static_cast<float>(m_bounceScale) * m_bounced[i];
    std::vector<vec3> bounced = bouncesOf(lit);
    // The residual stays that of the old bounces until their scale is known.
    const std::vector<vec3> before = std::move(m_bounced);
    setBounced(std::move(bounced), m_bounceScale);
    setBounced(std::move(m_bounced), bestBounceScale());
    m_fit.solve(1);
}

LostLights RelightModel::lights() const {
    LostLights lights;
    lights.lightmap = m_input.fingerprint;
    lights.compensate = m_input.compensation;
    lights.faintest = kFaintestLight;
    lights.faintestSurface = m_faintestSurface;
    lights.bounce = static_cast<float>(m_bounceScale);
    lights.floor = m_input.compensation * m_input.floor;
    const vec3 ambient = m_fit.strength(m_ambientSource);
    lights.ambientValue = largestOf(ambient);
    if (lights.ambientValue > 0) lights.ambientColor = ambient / lights.ambientValue;
    for (size_t k = 0; k < m_kindSources.size(); ++k) {
        const EmitterKind& kind = m_input.scene.kinds[k];
        const vec3 radiosity = m_fit.strength(m_kindSources[k]);
        const float largest = largestOf(radiosity);
        auto& list = kind.type == EmitterKind::Type::SkyDome ? lights.skyLights : lights.surfaceLights;
        list.push_back(
            {kind.material, largest / radiosityOfValue(kind.type), largest > 0 ? radiosity / largest : vec3(1)});
    }
    for (const Sun& sun : m_suns)
        if (const vec3 irradiance = m_fit.strength(sun.source); largestOf(irradiance) >= kFaintestSun)
            lights.suns.push_back({sun.sun.direction, irradiance, sun.sun.halfAngleRadians});
    for (const FoundLight& found : m_points->lights()) {
        PointLight light;
        light.origin = found.origin;
        light.intensity = m_fit.strength(found.source);
        light.spot = !found.cone.isPoint();
        if (light.spot) {
            light.direction = found.cone.axis;
            light.cosOuter = 1 / std::hypot(1.0f, found.cone.radius);
        }
        if (largestOf(light.intensity) > 0) lights.points.push_back(light);
    }
    return lights;
}

LightScore RelightModel::score() const {
    ScoreSum sum;
    const std::vector<vec3> lit = direct();
    for (size_t i = 0; i < lit.size(); ++i)
        if (m_fit.targets()[i].weight > 0)
            sum.add(largestOf(m_input.luxelOf(lit[i] + static_cast<float>(m_bounceScale) * m_bounced[i])),
                    largestOf(m_input.scene.luxels.patches[i].baked), m_fit.targets()[i].weight);
    return sum.result();
}

LightScore RelightModel::scoreHeldOut(size_t count) const {
    const LuxelMap& map = m_input.scene.luxels;
    std::vector<const PlacedLuxel*> luxels;
    std::vector<double> areas{0};
    for (size_t p = 0; p < map.patches.size(); ++p) {
        if (!m_input.isShown[p]) continue;
        const LuxelPatch& patch = map.patches[p];
        for (uint32_t i = patch.firstLuxel; i < patch.firstLuxel + patch.luxelCount; ++i) {
            if (!isHeldOut(map.luxels[i].texel, m_input.settings.luxels.heldOutOneIn)) continue;
            luxels.push_back(&map.luxels[i]);
            areas.push_back(areas.back() + map.luxels[i].areaQu2);
        }
    }
    std::vector<const PlacedLuxel*> chosen;
    std::vector<LightReceiver> receivers;
    for (size_t i = 0; i < count && !luxels.empty(); ++i) { // evenly over the area, in the map's order
        const double at = areas.back() * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const auto found = static_cast<size_t>(std::upper_bound(areas.begin(), areas.end(), at) - areas.begin()) - 1;
        const PlacedLuxel& luxel = *luxels[std::min(found, luxels.size() - 1)];
        const LightReceiver receiver = m_input.scene.receiverOf(luxel);
        if (!m_input.scene.open.sees(receiver.position[0], receiver.normal[0])) continue;
        chosen.push_back(&luxel);
        receivers.push_back(receiver);
    }
    const std::vector<vec3> lit = irradianceAt(receivers);
    ScoreSum sum;
    for (size_t i = 0; i < lit.size(); ++i)
        sum.add(largestOf(m_input.luxelOf(lit[i])), largestOf(map.bakedAt(*chosen[i])), 1);
    return sum.result();
}

/// All sources, traced anew, and bounces.
std::vector<vec3> RelightModel::irradianceAt(const std::vector<LightReceiver>& receivers) const {
    const LightScene& scene = m_input.scene;
    const HemisphereRays rays(scene, receivers, 2 * m_input.settings.hemisphereRays);
    std::vector<vec3> radiosity = direct();
    for (size_t i = 0; i < radiosity.size(); ++i)
        radiosity[i] =
            scene.luxels.patches[i].albedo * static_cast<float>(m_bounceScale) *
            glm::min(radiosity[i] + static_cast<float>(m_bounceScale) * m_bounced[i], vec3(kBrightestBounce));
    std::vector<vec3> lit = rays.gather(radiosity);
    const auto addLight = [&](const LightColumn& column, const vec3& strength) {
        for (size_t i = 0; i < column.receiver.size(); ++i)
            lit[column.receiver[i]] += column.value[i] * strength;
    };
    std::vector<float> faintest;
    for (const size_t source : m_kindSources) {
        const float strength = largestOf(m_fit.strength(source));
        faintest.push_back(strength > 0 ? m_faintestSurface / strength : -1);
    }
    const std::vector<LightColumn> emitters = traceEmitters(scene, receivers, faintest), skies = rays.skyColumns(scene);
    for (size_t k = 0; k < emitters.size(); ++k) {
        addLight(emitters[k], m_fit.strength(m_kindSources[k]));
        addLight(skies[k], m_fit.strength(m_kindSources[k]));
    }
    for (vec3& light : lit)
        light += m_fit.strength(m_ambientSource);
    for (const Sun& sun : m_suns)
        addLight(traceSun(scene, receivers, sun.sun), m_fit.strength(sun.source));
    m_points->addLightAt(receivers, lit);
    return lit;
}

} // namespace q3rt
