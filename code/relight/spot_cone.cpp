#include "relight/spot_cone.hpp"

#include "relight/sampling.hpp"

namespace q3rt {
namespace {

constexpr float kFirstRadii[] = {0.3f, 0.6f, 1.0f, 1.8f};
/// Radians of the axis, share of the radius; halved from the first to the last.
constexpr float kFirstStep = 0.3f, kLastStep = 0.02f;

} // namespace

FittedCone fitCone(const LightScene& scene, const LightFit& fit, const vec3& origin, const LightColumn& column,
                   const vec3& axis, double price) {
    FittedCone best;
    const auto consider = [&](const LightCone& cone) {
        const double gain = fit.gainOf(withinCone(scene.receivers, origin, cone, column), price);
        if (gain > best.gain) best = {cone, gain};
    };
    for (const float radius : kFirstRadii)
        consider({axis, radius});
    for (float step = kFirstStep; step > kLastStep && best.gain > 0; step /= 2) {
        const LightCone from = best.cone;
        vec3 tangent, bitangent;
        completeFrame(from.axis, tangent, bitangent);
        for (const vec3& side : {tangent, -tangent, bitangent, -bitangent})
            consider({glm::normalize(from.axis + step * side), from.radius});
        consider({from.axis, from.radius * (1 + step)});
        consider({from.axis, from.radius / (1 + step)});
    }
    return best;
}

} // namespace q3rt
