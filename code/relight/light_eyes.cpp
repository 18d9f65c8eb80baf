#include "relight/light_eyes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "relight/sampling.hpp"

namespace q3rt {
namespace {

constexpr int kEyeRays = 128;
constexpr float kMinPointDistanceQu = 16;
/// Axes within these cosines of a spot's own belong to its cone: that axis alone, and it with its neighbours.
constexpr float kConeCosines[] = {0.95f, 0.7f};

/// The 26 directions to the neighbours in a grid.
struct Axes {
    static constexpr size_t kCount = 26;
    vec3 axis[kCount];
    std::vector<size_t> cones[2][kCount]; ///< axes within each cone
    Axes() {
        size_t count = 0;
        for (int i = 0; i < 27; ++i)
            if (i != 13) axis[count++] = glm::normalize(vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        for (size_t size = 0; size < 2; ++size)
            for (size_t a = 0; a < kCount; ++a)
                for (size_t b = 0; b < kCount; ++b)
                    if (glm::dot(axis[a], axis[b]) > kConeCosines[size]) cones[size][a].push_back(b);
    }
    uint32_t nearest(const vec3& direction) const {
        uint32_t best = 0;
        for (uint32_t i = 1; i < kCount; ++i)
            if (glm::dot(axis[i], direction) > glm::dot(axis[best], direction)) best = i;
        return best;
    }
};
const Axes& axes() {
    static const Axes all;
    return all;
}

/// What rays say together.
struct Sum {
    vec3 gradient{0};
    float square = 0;
    void add(const Sum& other) {
        gradient += other.gradient;
        square += other.square;
    }
    float gain(float price) const {
        const vec3 g = glm::max(gradient - price, 0.0f);
        return square > 0 ? glm::dot(g, g) / square : 0;
    }
};

} // namespace

SeenResidual::SeenResidual(const LightFit& fit, const LuxelMap& luxels, double unitPrice)
    : weighted(luxels.patches.size(), vec3(0))
    , weight(luxels.patches.size(), 0)
    , price(unitPrice) {
    for (size_t i = 0; i < weight.size(); ++i) {
        const float area = luxels.patches[i].areaQu2;
        if (!(area > 0)) continue;
        const vec3 each = fit.weightAt(i) / area;
        weighted[i] = each * fit.residual()[i];
        weight[i] = largestOf(each);
    }
}

LightEye::LightEye(const LightScene& scene, const vec3& origin, int rayCount, uint32_t key)
    : m_origin(origin)
    , m_solidAngle(4 * std::numbers::pi_v<float> / static_cast<float>(rayCount)) {
    for (int i = 0; i < rayCount; ++i) {
        const vec3 direction = sphereDirection(planePoint(static_cast<uint32_t>(i), key));
        OccluderHit hit;
        if (!scene.occluders.closest(origin, direction, scene.occluders.farQu(), hit)) continue;
        const int patch = scene.luxels.patchAt(hit.surface, hit.firstIndex, hit.barycentric);
        if (patch < 0) continue;
        const float cosine = -glm::dot(direction, scene.luxels.patches[static_cast<size_t>(patch)].normal);
        if (cosine <= 0) continue;
        const float distance = std::max(hit.t, kMinPointDistanceQu);
        m_looks.push_back({static_cast<uint32_t>(patch), cosine / (distance * distance), axes().nearest(direction)});
    }
}

LightEye::Worth LightEye::worth(const SeenResidual& seen) const {
    Sum bins[Axes::kCount], best;
    for (const Look& look : m_looks)
        bins[look.bin].add({seen.weighted[look.patch], seen.weight[look.patch] * look.irradiance});
    for (const Sum& bin : bins)
        best.add(bin);
    const auto price = static_cast<float>(seen.price / m_solidAngle);
    constexpr auto kHandicap = static_cast<float>(kSpotHandicap);
    float gain = best.gain(price);
    Worth worth;
    for (const auto& cones : axes().cones)
        for (size_t a = 0; a < Axes::kCount; ++a) {
            Sum cone;
            for (const size_t bin : cones[a])
                cone.add(bins[bin]);
            if (cone.gain(price) <= gain * kHandicap) continue;
            gain = cone.gain(price) / kHandicap;
            best = cone;
            worth.axis = axes().axis[a];
        }
    worth.gain = double(gain) * m_solidAngle;
    if (best.square > 0) worth.strength = glm::max(best.gradient - price, 0.0f) / best.square;
    return worth;
}

std::vector<LightEye> openEyes(const LightScene& scene) {
    const std::vector<vec3>& points = scene.open.points();
    std::vector<LightEye> eyes(points.size(), LightEye(scene, vec3(0), 1, 0));
    parallelFor(points.size(),
                [&](size_t i) { eyes[i] = LightEye(scene, points[i], kEyeRays, static_cast<uint32_t>(i)); });
    return eyes;
}

} // namespace q3rt
