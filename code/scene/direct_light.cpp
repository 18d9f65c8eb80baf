#include "scene/direct_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace q3rt {
namespace {

/// Point lights count no closer than this (how the maps were baked), qu.
constexpr float kMinPointDistanceQu = 16;

float uniform(std::mt19937& random) { return std::uniform_real_distribution<float>(0, 1)(random); }

/// Any two unit vectors that complete a frame (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
void completeFrame(const vec3& n, vec3& tangent, vec3& bitangent) {
    const float sign = std::copysign(1.0f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    tangent = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = {b, sign + n.y * n.y * a, -n.y};
}

vec3 cosineDirection(const vec3& normal, float u1, float u2) {
    vec3 tangent, bitangent;
    completeFrame(normal, tangent, bitangent);
    const float radius = std::sqrt(u1), angle = 2 * kPi * u2;
    return glm::normalize(radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent +
                          std::sqrt(std::max(0.0f, 1 - u1)) * normal);
}

vec3 coneDirection(const vec3& axis, float halfAngleRadians, float u1, float u2) {
    vec3 tangent, bitangent;
    completeFrame(axis, tangent, bitangent);
    const float cosine = 1 - u1 * (1 - std::cos(halfAngleRadians)),
                sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    return glm::normalize(sine * std::cos(2 * kPi * u2) * tangent + sine * std::sin(2 * kPi * u2) * bitangent +
                          cosine * axis);
}

/// Part of a polygon above the plane through 0 with normal n (Sutherland and Hodgman 1974).
std::vector<dvec3> clipToHorizon(const std::vector<dvec3>& polygon, const dvec3& n) {
    std::vector<dvec3> result;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = glm::dot(a, n), db = glm::dot(b, n);
        if (da >= 0) result.push_back(a);
        if ((da >= 0) != (db >= 0)) result.push_back(a + (b - a) * (da / (da - db)));
    }
    return result;
}

} // namespace

double triangleFormFactor(const vec3& point, const vec3& normal, const vec3 corner[3]) {
    const dvec3 p(point), n(normal);
    const std::vector<dvec3> polygon =
        clipToHorizon({dvec3(corner[0]) - p, dvec3(corner[1]) - p, dvec3(corner[2]) - p}, n);
    double sum = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const dvec3 axis = glm::cross(a, b);
        const double length = glm::length(axis);
        // A corner on the point, or an edge through it: its angle's plane contains every normal, the term vanishes.
        if (length > 0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(axis, n) / length;
    }
    return std::abs(sum) / (2 * std::numbers::pi);
}

DirectLightTracer::DirectLightTracer(const World& world, const MaterialLibrary& materials, const LightSet& lights)
    : m_lights(lights)
    , m_occluders(world, materials)
    , m_radiosity(world.surfaces.size(), vec3(0))
    , m_upperRadiosity(world.surfaces.size(), vec3(0)) {
    for (const SkyLight& sky : lights.skies)
        (sky.upperHemisphere ? m_upperRadiosity : m_radiosity)[static_cast<size_t>(sky.surface)] +=
            sky.radiosity * sky.color;
}

bool DirectLightTracer::reachesSky(const vec3& origin, const vec3& direction, int& sky) const {
    OccluderHit hit;
    if (!m_occluders.closest(origin, direction, m_occluders.farQu(), hit)) return false;
    sky = static_cast<int>(hit.surface);
    return m_occluders.isSky(hit.surface);
}

vec3 DirectLightTracer::surfaceLight(const vec3& origin, const vec3& normal, int rays, std::mt19937& random) const {
    vec3 sum(0);
    for (const TriangleLight& light : m_lights.triangles) {
        const float height = glm::dot(origin - light.corner[0], light.normal);
        if (light.bspModel != 0 || (height <= 0 && !light.twoSided) || isTooFaint(light, origin, normal)) continue;
        const double factor = triangleFormFactor(origin, normal, light.corner);
        if (factor <= 0) continue;
        // The visible share is weighted by what each sample would give, so that shadow edges stay unbiased.
        double lit = 0, all = 0;
        for (int i = 0; i < rays; ++i) {
            const float root = std::sqrt(uniform(random)), v = uniform(random);
            const vec3 target =
                (1 - root) * light.corner[0] + root * (1 - v) * light.corner[1] + root * v * light.corner[2];
            const vec3 to = target - origin;
            const double squared = glm::dot(to, to),
                         cosines = double(glm::dot(to, normal)) * std::abs(glm::dot(to, light.normal));
            if (squared <= 0 || cosines <= 0) continue;
            const double weight = cosines / (squared * squared);
            all += weight;
            // One part in a thousand short of the emitter, which is an occluder itself.
            if (!m_occluders.occluded(origin, to, 0.999f)) lit += weight;
        }
        if (all > 0) sum += light.radiance * (kPi * static_cast<float>(factor * lit / all));
    }
    return sum;
}

vec3 DirectLightTracer::sunLight(const vec3& origin, const vec3& normal, std::mt19937& random) const {
    vec3 sum(0);
    for (const SunLight& sun : m_lights.suns) {
        const vec3 direction = coneDirection(sun.direction, sun.halfAngleRadians, uniform(random), uniform(random));
        int sky = -1;
        const float cosine = glm::dot(direction, normal);
        if (cosine > 0 && reachesSky(origin, direction, sky)) sum += sun.irradiance * cosine;
    }
    return sum;
}

vec3 DirectLightTracer::skyLight(const vec3& origin, const vec3& normal, int rays, std::mt19937& random) const {
    if (m_lights.skies.empty() || rays <= 0) return vec3(0);
    // Cosine-weighted: the share of rays that reach a sky is its form factor. Stratified in the first dimension.
    vec3 sum(0);
    for (int i = 0; i < rays; ++i) {
        const float u1 = (static_cast<float>(i) + uniform(random)) / static_cast<float>(rays);
        int sky = -1;
        const vec3 direction = cosineDirection(normal, u1, uniform(random));
        if (!reachesSky(origin, direction, sky)) continue;
        sum += m_radiosity[static_cast<size_t>(sky)];
        if (direction.z > 0) sum += m_upperRadiosity[static_cast<size_t>(sky)];
    }
    return sum / static_cast<float>(rays);
}

vec3 DirectLightTracer::pointLight(const vec3& origin, const vec3& normal) const {
    vec3 sum(0);
    for (const PointLight& light : m_lights.points) {
        const vec3 to = light.origin - origin;
        const float distance = std::max(glm::length(to), kMinPointDistanceQu);
        const float cosine = glm::dot(to, normal) / std::max(glm::length(to), std::numeric_limits<float>::min());
        const float share = light.spot ? spotShare(light, -to) : 1.0f;
        if (cosine <= 0 || share <= 0) continue;
        const float faintest = light.faintest * (distance * distance) / cosine;
        if (std::max({light.intensity.x, light.intensity.y, light.intensity.z}) <= faintest) continue;
        if (!m_occluders.occluded(origin, to, 1)) sum += light.intensity * (share * cosine / (distance * distance));
    }
    return sum;
}

DirectLight DirectLightTracer::at(const vec3& origin, const vec3& normal, const DirectLightSettings& settings,
                                  std::mt19937& random) const {
    return {surfaceLight(origin, normal, settings.shadowRaysPerLight, random), sunLight(origin, normal, random),
            skyLight(origin, normal, settings.skyRays, random), pointLight(origin, normal)};
}

} // namespace q3rt
