// Columns of emissive surfaces: how much of a receiver's hemisphere they fill, exactly near it, and which share of that
// is in sight, by shadow rays toward points on them drawn in proportion to what they give.

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "relight/light_columns.hpp"
#include "relight/sampling.hpp"
#include "scene/direct_light.hpp"

namespace q3rt {
namespace {

/// Shadow rays toward each kind at a receiver: at least, and more in proportion to its share of all light.
constexpr int kLeastRays = 4;
constexpr float kMoreRays = 28;
/// Light triangles lie on the planes that divide the map: half a unit off is inside the leaf that they light.
constexpr float kOffFaceQu = 0.5f;
/// A ray toward an emitter ends one part in a thousand short of it: it is an occluder itself.
constexpr float kShortOfLight = 0.999f;

class EmitterTracer {
  public:
    EmitterTracer(const LightScene& scene, const std::vector<LightReceiver>& receivers,
                  const std::vector<float>& faintest)
        : m_scene(scene)
        , m_receivers(receivers)
        , m_faintest(faintest) {
        for (const TriangleLight& light : scene.lights.triangles) {
            const vec3 centre = (light.corner[0] + light.corner[1] + light.corner[2]) / 3.0f;
            const auto clusterAt = [&](const vec3& point) {
                return scene.world.clusterOf(point + kOffFaceQu * light.normal);
            };
            // The middle, and near the corners: a triangle may lie in several clusters.
            m_places.push_back({centre,
                                {clusterAt(centre), clusterAt(glm::mix(light.corner[0], centre, 0.1f)),
                                 clusterAt(glm::mix(light.corner[1], centre, 0.1f)),
                                 clusterAt(glm::mix(light.corner[2], centre, 0.1f))}});
        }
    }

    /// Irradiance of each kind at one receiver, radiosity 1.
    void trace(size_t number, std::vector<float>& ofKind) const {
        const LightReceiver& receiver = m_receivers[number];
        std::vector<std::vector<Share>> shares(m_scene.kinds.size());
        float all = 0;
        for (size_t k = 0; k < shares.size(); ++k) {
            if (m_faintest[k] >= 0) shares[k] = sharesOf(m_scene.kinds[k], m_faintest[k], receiver);
            if (!shares[k].empty()) all += shares[k].back().sum * m_scene.kinds[k].radiosity;
        }
        for (size_t k = 0; k < shares.size(); ++k) {
            if (shares[k].empty()) continue;
            const float sum = shares[k].back().sum;
            const int rays = kLeastRays + static_cast<int>(kMoreRays * sum * m_scene.kinds[k].radiosity / all);
            ofKind[k] = sum * visibleShare(receiver, shares[k], rays, static_cast<uint32_t>(number * 31 + k));
        }
    }

  private:
    struct Place {
        vec3 centre;
        std::array<int, 4> clusters;
    };
    struct Share {
        uint32_t triangle;
        float sum; ///< up to and including this one
    };
    const LightScene& m_scene;
    const std::vector<LightReceiver>& m_receivers;
    const std::vector<float>& m_faintest;
    std::vector<Place> m_places; ///< by triangle

    /// Share of the hemisphere that a triangle fills, unshadowed.
    float shareOf(uint32_t triangle, const vec3& point, const vec3& normal, float faintest) const {
        const TriangleLight& light = m_scene.lights.triangles[triangle];
        const vec3 to = m_places[triangle].centre - point;
        const float squared = glm::dot(to, to), height = -glm::dot(to, light.normal);
        if (height <= 0 && !light.twoSided) return 0;
        if (!isFarFrom(light, squared)) return static_cast<float>(triangleFormFactor(point, normal, light.corner));
        const float cosine = glm::dot(to, normal);
        const float share = cosine > 0 ? light.areaQu2 * cosine * std::abs(height) / (kPi * squared * squared) : 0;
        return share > faintest ? share : 0;
    }

    std::vector<Share> sharesOf(const EmitterKind& kind, float faintest, const LightReceiver& receiver) const {
        std::vector<Share> shares;
        float sum = 0;
        for (const uint32_t triangle : kind.triangles) {
            const auto& clusters = m_places[triangle].clusters;
            if (std::none_of(clusters.begin(), clusters.end(),
                             [&](int cluster) { return m_scene.mayMeet(cluster, receiver.cluster); }))
                continue;
            float share = 0;
            for (int p = 0; p < LightReceiver::kPoints; p += 2)
                share += 0.5f * shareOf(triangle, receiver.position[p], receiver.normal[p], faintest);
            if (!(share > 0)) continue;
            sum += share;
            shares.push_back({triangle, sum});
        }
        return shares;
    }

    float visibleShare(const LightReceiver& receiver, const std::vector<Share>& shares, int rays, uint32_t key) const {
        float lit = 0, all = 0;
        for (int i = 0; i < rays; ++i) {
            const float pick = (static_cast<float>(i) + 0.5f) / static_cast<float>(rays) * shares.back().sum;
            const auto found = std::lower_bound(shares.begin(), shares.end() - 1, pick,
                                                [](const Share& s, float v) { return s.sum < v; });
            const float width = found->sum - (found == shares.begin() ? 0 : (found - 1)->sum);
            const TriangleLight& light = m_scene.lights.triangles[found->triangle];
            const vec2 random = planePoint(static_cast<uint32_t>(i), key);
            const float root = std::sqrt(random.x);
            const vec3 target = (1 - root) * light.corner[0] + root * (1 - random.y) * light.corner[1] +
                                root * random.y * light.corner[2];
            const int p = i % LightReceiver::kPoints;
            const vec3 to = target - receiver.position[p];
            const float squared = glm::dot(to, to), cosine = glm::dot(to, receiver.normal[p]),
                        height = -glm::dot(to, light.normal);
            if (!(squared > 0) || cosine <= 0 || (height <= 0 && !light.twoSided) || !(width > 0)) continue;
            const float weight = light.areaQu2 * cosine * std::abs(height) / (squared * squared * width);
            all += weight;
            if (!m_scene.occluders.occluded(receiver.position[p], to, kShortOfLight)) lit += weight;
        }
        return all > 0 ? lit / all : 0;
    }
};

} // namespace

std::vector<LightColumn> traceEmitters(const LightScene& scene, const std::vector<LightReceiver>& receivers,
                                       const std::vector<float>& faintest) {
    std::vector<LightColumn> columns(scene.kinds.size());
    if (scene.lights.triangles.empty()) return columns;
    const EmitterTracer tracer(scene, receivers, faintest);
    std::vector<std::vector<float>> values(receivers.size(), std::vector<float>(scene.kinds.size(), 0));
    parallelFor(receivers.size(), [&](size_t i) { tracer.trace(i, values[i]); });
    for (size_t i = 0; i < receivers.size(); ++i)
        for (size_t k = 0; k < columns.size(); ++k)
            columns[k].append(i, values[i][k]);
    return columns;
}

} // namespace q3rt
