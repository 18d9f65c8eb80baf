// Is it the model or the search, where relighting does not find the lights of a map's source? Both stand in the same
// model: the lights of the source, and those of lights/MAP.ent, as one column with one strength, beside the scripts'
// emitters, the map's suns, bounces of the baked light and light that is everywhere, each with the strength that fits
// best. Grey, at the patches of the fit, by its own measure.
//
//   bench_truth FOLDER [MAP...]   FOLDER: of MAP.ent; without names all maps whose source is in the archives

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "host/common/file_bytes.hpp"
#include "host/common/session.hpp"
#include "relight/light_score.hpp"
#include "relight/light_truth.hpp"
#include "relight/lost_units.hpp"
#include "relight/relight_input.hpp"

namespace {

using namespace q3rt;

constexpr int kReweighings = 6;
/// A ball of lights that others replace for so little of the cost is not told by the lightmap: what relighting asks of
/// every light that it adds.
constexpr double kUntold = 1e-4;
constexpr double kHeirLikeness = 0.2;
/// Of a map at most so many lights are asked, evenly over the list.
constexpr size_t kAskedLights = 150;

float greyOf(const vec3& v) { return (v.x + v.y + v.z) / 3; }

std::string_view asText(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// As they were written: a column of strength 1 a light.
std::vector<LightColumn> traceLights(const LightScene& scene, const std::vector<PointLight>& lights, float faintest) {
    std::vector<LightColumn> columns(lights.size());
    parallelFor(lights.size(), [&](size_t i) {
        const PointLight& light = lights[i];
        const LightCone cone = light.spot ? LightCone{light.direction, light.tangent()} : LightCone{};
        columns[i] =
            withinCone(scene.receivers, light.origin, cone,
                       tracePoint(scene, scene.receivers, light.origin, faintest / largestOf(light.intensity)));
        for (float& value : columns[i].value)
            value *= greyOf(light.intensity);
    });
    return columns;
}

LightColumn sumOf(const std::vector<LightColumn>& columns, size_t receiverCount) {
    std::vector<float> sum(receiverCount, 0);
    for (const LightColumn& column : columns)
        for (size_t i = 0; i < column.receiver.size(); ++i)
            sum[column.receiver[i]] += column.value[i];
    LightColumn result;
    for (size_t i = 0; i < sum.size(); ++i)
        result.append(i, sum[i]);
    return result;
}

/// Everything but point lights.
LightFit fitOfTheRest(const RelightInput& input) {
    std::vector<FitTarget> targets = input.makeTargets();
    for (FitTarget& target : targets)
        target.light = vec3(greyOf(target.light));
    LightFit fit(std::move(targets));
    for (size_t k = 0; k < input.kindColumns.size(); ++k)
        fit.add(input.kindColumns[k]);
    for (const SunLight& sun : input.scene.lights.suns)
        fit.add(traceSun(input.scene, input.scene.receivers, sun));
    std::vector<vec3> radiosity;
    for (size_t i = 0; i < input.scene.receivers.size(); ++i)
        radiosity.push_back(input.scene.luxels.patches[i].albedo * input.bakedIrradiance(i));
    LightColumn bounces, everywhere;
    const std::vector<vec3> bounced = input.rays.gather(radiosity);
    for (size_t i = 0; i < bounced.size(); ++i) {
        bounces.append(i, greyOf(bounced[i]));
        everywhere.append(i, 1);
    }
    fit.setLimit(fit.add(std::move(bounces)), 1.5f);
    fit.setLimit(fit.add(std::move(everywhere)), input.ambientLimit);
    return fit;
}

double correlationOf(const RelightInput& input, const LightFit& fit) {
    ScoreSum sum;
    for (size_t i = 0; i < fit.residual().size(); ++i)
        if (const FitTarget& target = fit.targets()[i]; target.weight > 0)
            sum.add(input.luxelOf(target.light - fit.residual()[i]).x, greyOf(input.scene.luxels.patches[i].baked),
                    target.weight);
    return sum.result().correlation;
}

struct Agreement {
    double correlation, cost; ///< cost: as a share of that without any light
    float strength;           ///< times what was written
};
Agreement agree(const RelightInput& input, const std::vector<PointLight>& lights, float faintest) {
    LightFit fit = fitOfTheRest(input);
    const double dark = fit.cost();
    const size_t source = fit.add(sumOf(traceLights(input.scene, lights, faintest), input.scene.receivers.size()));
    fit.solve(kReweighings);
    return {correlationOf(input, fit), fit.cost() / dark, fit.strength(source).x};
}

/// Share of the source's energy in balls that can go without the lightmap telling: others give their light as well.
double untoldShare(const RelightInput& input, const std::vector<PointLight>& lights) {
    LightFit fit = fitOfTheRest(input);
    const std::vector<LightColumn> columns = traceLights(input.scene, lights, kFaintestLight);
    const size_t first = fit.sourceCount();
    for (const LightColumn& column : columns) {
        fit.setStrength(fit.add(column), vec3(1));
    }
    for (int i = 0; i < 3; ++i) { // the rest at its best beside what was written
        fit.reweigh();
        for (int round = 0; round < 20; ++round)
            for (size_t source = 0; source < first; ++source)
                fit.setStrength(source, fit.bestStrength(source));
    }
    const double cost = fit.cost();
    double all = 0, untold = 0;
    for (size_t i = 0; i < lights.size(); i += 1 + lights.size() / kAskedLights) {
        std::vector<size_t> heirs;
        std::vector<float> before;
        for (size_t source = 0; source < fit.sourceCount(); ++source)
            if (source < first || fit.likeness(source, first + i) > kHeirLikeness) {
                heirs.push_back(source);
                before.push_back(fit.strength(source).x);
            }
        const auto isInBall = [&](size_t source) {
            return source >= first && glm::length(lights[source - first].origin - lights[i].origin) <= kTruthBallQu;
        };
        std::vector<size_t> ball;
        for (size_t source = first; source < fit.sourceCount(); ++source)
            if (isInBall(source)) {
                ball.push_back(source);
                fit.setStrength(source, vec3(0));
            }
        std::vector<size_t> outside;
        std::copy_if(heirs.begin(), heirs.end(), std::back_inserter(outside), [&](size_t h) { return !isInBall(h); });
        fit.settleAmong(outside);
        const double energy = largestOf(lights[i].intensity);
        all += energy;
        if (fit.cost() - cost < kUntold * cost) untold += energy;
        for (const size_t source : ball)
            fit.setStrength(source, vec3(1));
        for (size_t k = 0; k < heirs.size(); ++k)
            fit.setStrength(heirs[k], vec3(before[k]));
    }
    return all > 0 ? untold / all : 0;
}

void printMap(Pk3FileSource& files, const std::string& folder, const std::string& map) {
    TextureLibrary textures(files, TextureSettings{});
    MaterialLibrary materials(files, textures, MaterialSettings{});
    const auto world = loadWorld(files, "maps/" + map + ".bsp", materials, WorldSettings{});
    const auto source = files.read("sources/maps/" + map + ".map");
    if (!source) throw ContentError(map + " has no source in the archives");
    const std::vector<PointLight> truth = parseMapSourceLights(asText(*source));
    const std::string name = folder + "/" + map + ".ent";
    const std::vector<PointLight> found = parseLostLights(asText(readFileBytes(name)), name).points;
    const RelightInput input(*world, materials, {});
    std::printf("| %s | %zu |", map.c_str(), truth.size());
    for (const float faintest : {0.01f, 0.5f, kFaintestLight, 2.0f})
        std::printf(" %.3f%s", agree(input, truth, faintest).correlation, faintest < 2 ? "," : " |");
    const Agreement at = agree(input, truth, kFaintestLight), ours = agree(input, found, kFaintestLight);
    std::printf(" %.2f | %.3f | %.1f %%, %.1f %% | %.0f %% |\n", double(at.strength), ours.correlation, 100 * at.cost,
                100 * ours.cost, 100 * untoldShare(input, truth));
    std::fflush(stdout);
}

} // namespace

int main(int count, char** arguments) {
    try {
        if (count < 2) throw ContentError("bench_truth FOLDER [MAP...]: the folder of MAP.ent is missing");
        const auto files = openGame({});
        std::vector<std::string> maps(arguments + 2, arguments + count);
        if (maps.empty())
            for (const std::string& file : files->list("sources/maps", ".map"))
                maps.push_back(file.substr(0, file.size() - 4));
        std::puts("| map | lights | correlation: beyond 0, 0.5, 1, 2 luxel units | strength | of those found | cost | "
                  "untold |\n|---|---|---|---|---|---|---|");
        for (const std::string& map : maps)
            printMap(*files, arguments[1], map);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_truth: %s\n", error.what());
        return 1;
    }
    return 0;
}
