#include "relight/sun_search.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "relight/sampling.hpp"

namespace q3rt {
namespace {

/// Directions looked at first: some 15 degrees apart.
constexpr uint32_t kDirections = 160;
/// Suns stand no deeper below the horizon: sine.
constexpr float kLowest = -0.3f;
/// Steps in which the best direction is turned, radians, halved from the first to the last.
constexpr float kFirstTurn = 0.1f, kLastTurn = 0.004f;
constexpr int kSides = 8;

/// One ray a receiver: only for comparing directions.
double gainOf(const LightScene& scene, const LightFit& fit, const vec3& direction) {
    LightColumn column;
    for (size_t i = 0; i < scene.receivers.size(); ++i) {
        const LightReceiver& receiver = scene.receivers[i];
        const float cosine = glm::dot(direction, receiver.normal[0]);
        OccluderHit hit;
        if (fit.targets()[i].weight > 0 && cosine > 0 &&
            scene.occluders.closest(receiver.position[0], direction, scene.occluders.farQu(), hit) &&
            scene.occluders.isSky(hit.surface))
            column.append(i, cosine);
    }
    return fit.gainOf(column, 0);
}

/// Index of the direction that gains most, and what it gains.
std::pair<size_t, double> bestOf(const LightScene& scene, const LightFit& fit, const std::vector<vec3>& directions) {
    std::vector<double> gains(directions.size());
    parallelFor(directions.size(), [&](size_t i) { gains[i] = gainOf(scene, fit, directions[i]); });
    const auto best = std::max_element(gains.begin(), gains.end());
    return {static_cast<size_t>(best - gains.begin()), *best};
}

} // namespace

std::optional<vec3> findSun(const LightScene& scene, const LightFit& fit, double leastGain) {
    if (std::all_of(scene.skyKindOfSurface.begin(), scene.skyKindOfSurface.end(), [](int kind) { return kind < 0; }))
        return std::nullopt;
    std::vector<vec3> directions;
    for (uint32_t i = 0; i < kDirections; ++i)
        if (const vec3 direction = sphereDirection(planePoint(i, 0)); direction.z > kLowest)
            directions.push_back(direction);
    auto [index, gain] = bestOf(scene, fit, directions);
    if (gain < leastGain * fit.cost()) return std::nullopt;
    vec3 direction = directions[index];
    for (float turn = kFirstTurn; turn > kLastTurn; turn /= 2) {
        vec3 tangent, bitangent;
        completeFrame(direction, tangent, bitangent);
        std::vector<vec3> near;
        for (int side = 0; side < kSides; ++side) {
            const float angle = glm::radians(360.0f / kSides) * static_cast<float>(side);
            near.push_back(
                glm::normalize(direction + turn * (std::cos(angle) * tangent + std::sin(angle) * bitangent)));
        }
        const auto [nearest, nearGain] = bestOf(scene, fit, near);
        if (nearGain <= gain) continue;
        gain = nearGain;
        direction = near[nearest];
    }
    return direction;
}

} // namespace q3rt
