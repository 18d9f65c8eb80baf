#include "relight/light_columns.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "relight/sampling.hpp"

namespace q3rt {
namespace {

/// Point lights count no closer than this (how the maps were baked), qu.
constexpr float kMinPointDistanceQu = 16;
/// Light this many times the faintest is sampled at all points of a receiver, or at every second.
constexpr float kStrong = 6, kWeak = 1.5f;

LightColumn columnOf(const std::vector<float>& values) {
    LightColumn column;
    for (size_t i = 0; i < values.size(); ++i)
        column.append(i, values[i]);
    return column;
}

} // namespace

LightColumn traceSun(const LightScene& scene, const std::vector<LightReceiver>& receivers, const SunLight& sun) {
    std::vector<float> values(receivers.size(), 0);
    parallelFor(receivers.size(), [&](size_t i) {
        for (int p = 0; p < LightReceiver::kPoints; ++p) {
            const vec3 direction = coneDirection(sun.direction, sun.halfAngleRadians,
                                                 planePoint(static_cast<uint32_t>(p), static_cast<uint32_t>(i)));
            const float cosine = glm::dot(direction, receivers[i].normal[p]);
            OccluderHit hit;
            if (cosine > 0 &&
                scene.occluders.closest(receivers[i].position[p], direction, scene.occluders.farQu(), hit) &&
                scene.occluders.isSky(hit.surface))
                values[i] += cosine / LightReceiver::kPoints;
        }
    });
    return columnOf(values);
}

float pointIrradiance(const vec3& position, const vec3& normal, const vec3& origin) {
    const vec3 to = origin - position;
    const float squared = glm::dot(to, to), height = glm::dot(to, normal);
    if (!(height > 0)) return 0;
    return height / (std::sqrt(squared) * std::max(squared, kMinPointDistanceQu * kMinPointDistanceQu));
}

LightColumn tracePoint(const LightScene& scene, const std::vector<LightReceiver>& receivers, const vec3& origin,
                       float faintest) {
    LightColumn column;
    const int cluster = scene.world.clusterOf(origin);
    for (size_t i = 0; i < receivers.size(); ++i) {
        const LightReceiver& receiver = receivers[i];
        float value[LightReceiver::kPoints], sum = 0;
        for (int p = 0; p < LightReceiver::kPoints; ++p) {
            const float given = pointIrradiance(receiver.position[p], receiver.normal[p], origin);
            value[p] = given > faintest ? given / LightReceiver::kPoints : 0;
            sum += value[p];
        }
        if (!(sum > 0) || !scene.mayMeet(cluster, receiver.cluster)) continue;
        // Faint light needs no soft shadow edges: another point for each receiver.
        const int step = sum > kStrong * faintest ? 1 : sum > kWeak * faintest ? 2 : LightReceiver::kPoints;
        float lit = 0, asked = 0;
        for (int p = static_cast<int>(i) % step; p < LightReceiver::kPoints; p += step) {
            if (!(value[p] > 0)) continue;
            asked += value[p];
            if (!scene.occluders.occluded(receiver.position[p], origin - receiver.position[p], 1)) lit += value[p];
        }
        if (asked > 0) column.append(i, sum * lit / asked);
    }
    return column;
}

LightColumn withinCone(const std::vector<LightReceiver>& receivers, const vec3& origin, const LightCone& cone,
                       const LightColumn& column) {
    if (cone.isPoint()) return column;
    LightColumn result;
    for (size_t i = 0; i < column.receiver.size(); ++i) {
        float share = 0;
        for (const vec3& point : receivers[column.receiver[i]].position)
            share += spotShare(point - origin, cone.axis, cone.radius) / LightReceiver::kPoints;
        result.append(column.receiver[i], share * column.value[i]);
    }
    return result;
}

} // namespace q3rt
