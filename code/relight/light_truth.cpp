#include "relight/light_truth.hpp"

#include <algorithm>

#include "formats/shader_script.hpp"
#include "relight/lost_units.hpp"
#include "scene/lights_build.hpp"

namespace q3rt {
namespace {

double energyOf(const PointLight& light) { return double(largestOf(light.intensity)) / kIntensityOfValue; }

double energyAround(const vec3& place, const std::vector<PointLight>& lights) {
    double sum = 0;
    for (const PointLight& light : lights)
        if (glm::length(light.origin - place) <= kTruthBallQu) sum += energyOf(light);
    return sum;
}

} // namespace

std::vector<PointLight> parseMapSourceLights(std::string_view text) {
    std::vector<MapEntity> entities;
    int line = 1, depth = 0; // 1: in an entity, 2 and more: in its brushes
    while (const auto token = nextScriptToken(text, line, false)) {
        if (*token == "{") {
            if (++depth == 1) entities.emplace_back();
        } else if (*token == "}") {
            --depth;
        } else if (depth == 1) {
            if (auto value = nextScriptToken(text, line, false))
                entities.back().pairs.emplace_back(*token, std::move(*value));
        }
    }
    LightSet lights;
    addEntityLights(entities, lights);
    return std::move(lights.points);
}

TruthReport compareWithTruth(const std::vector<PointLight>& truth, const std::vector<PointLight>& found) {
    TruthReport report;
    report.sourceLights = truth.size();
    double matched = 0, near = 0;
    for (const PointLight& light : truth) {
        const double energy = energyOf(light), all = energyAround(light.origin, truth),
                     got = energyAround(light.origin, found);
        report.sourceEnergy += energy;
        if (got * kTruthFactor >= all && got <= all * kTruthFactor) matched += energy;
    }
    for (const PointLight& light : found) {
        report.foundEnergy += energyOf(light);
        if (energyAround(light.origin, truth) > 0) near += energyOf(light);
    }
    if (report.sourceEnergy > 0) report.matchedShare = matched / report.sourceEnergy;
    if (report.foundEnergy > 0) report.nearShare = near / report.foundEnergy;
    return report;
}

} // namespace q3rt
