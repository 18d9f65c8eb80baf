#include "renderer_rt/baked_strengths.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "scene/luxels.hpp"

namespace q3rt {

namespace {

constexpr size_t kLuxels = 8192;
/// Shadow rays of a luxel to each kind in each of two estimates.
constexpr uint32_t kRays = 32;
/// Places within such a box that face alike are near one another, qu. A few luxels wide, and smaller than rooms.
constexpr float kNearQu = 128;
constexpr size_t kLeastOfGroup = 3;
/// Luxel units. What differs less within a group is for the most part light that is lost: it counts for as much less.
/// What differs more is a lamp close by: it counts for no more.
constexpr double kFullContrast = 40;
/// Of the lightmap's contrast, what a kind has to make by its script before the lightmap is believed as much as the
/// script.
constexpr double kDoubt = 0.01;
constexpr int kRounds = 200;
/// An estimate so near to 1 tells no change of the script.
constexpr double kSureChange = 0.15;
/// Below this a light is not worth its rays.
constexpr float kLeastFactor = 0.02f;

/// Numbers the kinds, and says of each light of the tables which it is of.
struct Kinds {
    std::vector<std::string> names;
    LightProbe::Kinds lights;

    uint32_t find(const std::string& name) {
        const auto found = std::ranges::find(names, name);
        if (found == names.end()) return names.push_back(name), static_cast<uint32_t>(names.size() - 1);
        return static_cast<uint32_t>(found - names.begin());
    }
};

std::string nameOfSurface(const World& world, const MaterialLibrary& materials, int surface, bool upward) {
    return materials.get(world.surfaces[static_cast<size_t>(surface)].material).name + (upward ? " (sky)" : "");
}
std::string nameOfSun(size_t number) { return formatText("sun %zu", number + 1); }
constexpr const char* kEntities = "entities";

Kinds sortLights(const World& world, const MaterialLibrary& materials, const LightSet& lights) {
    Kinds kinds;
    for (const TriangleLight& light : lights.triangles)
        kinds.lights.ofLight.push_back(kinds.find(nameOfSurface(world, materials, light.surface, false)));
    for (const TriangleLight& light : skyTriangles(world, materials, lights))
        kinds.lights.ofLight.push_back(kinds.find(nameOfSurface(world, materials, light.surface, light.upward)));
    for (size_t i = 0; i < lights.points.size(); ++i)
        kinds.lights.ofLight.push_back(kinds.find(kEntities));
    for (size_t i = 0; i < lights.suns.size(); ++i)
        kinds.lights.ofLight.push_back(kinds.find(nameOfSun(i)));
    kinds.lights.count = kinds.names.size();
    return kinds;
}

/// Which luxels are near one another.
using Group = std::tuple<int, int, int, int>;
Group groupOf(const Luxel& luxel) {
    const vec3 size = glm::abs(luxel.normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const ivec3 box(glm::floor(luxel.position / kNearQu));
    return {box.x, box.y, box.z, 2 * axis + (luxel.normal[axis] < 0 ? 1 : 0)};
}

/// Irradiance of luxels, luxel units: row i of `kinds` is luxel i's, by kind.
struct Columns {
    std::vector<vec3> baked;
    std::vector<vec3> kinds[2]; ///< two estimates that know nothing of one another: they tell their noise
};

/// From each value the mean of its group, so that only differences within it stay. `members`: numbers of luxels.
void takeMean(const std::vector<size_t>& members, size_t width, std::vector<vec3>& values) {
    for (size_t k = 0; k < width; ++k) {
        vec3 sum(0);
        for (const size_t i : members)
            sum += values[i * width + k];
        for (const size_t i : members)
            values[i * width + k] -= sum / static_cast<float>(members.size());
    }
}

/// Differences within groups, in units of how large they are there.
void compareWithinGroups(const std::vector<Luxel>& luxels, size_t width, Columns& columns) {
    std::map<Group, std::vector<size_t>> groups;
    for (size_t i = 0; i < luxels.size(); ++i)
        groups[groupOf(luxels[i])].push_back(i);
    for (const auto& [group, members] : groups) {
        takeMean(members, 1, columns.baked);
        for (auto& half : columns.kinds)
            takeMean(members, width, half);
        double energy = kFullContrast * kFullContrast;
        for (const size_t i : members) {
            vec3 all(0);
            for (size_t k = 0; k < width; ++k)
                all += 0.5f * (columns.kinds[0][i * width + k] + columns.kinds[1][i * width + k]);
            energy +=
                double(glm::dot(columns.baked[i], columns.baked[i]) + glm::dot(all, all)) / double(members.size());
        }
        const float scale = members.size() < kLeastOfGroup ? 0.0f : static_cast<float>(1 / std::sqrt(energy));
        for (const size_t i : members) {
            columns.baked[i] *= scale;
            for (auto& half : columns.kinds)
                for (size_t k = 0; k < width; ++k)
                    half[i * width + k] *= scale;
        }
    }
}

Columns traceColumns(const World& world, const LightProbe& probe, const Kinds& kinds, std::vector<Luxel>& luxels) {
    std::erase_if(luxels, [&](const Luxel& luxel) {
        return world.clusterOf(samplePointOf(luxel)) < 0; // covered by another face
    });
    const size_t width = kinds.names.size();
    Columns columns;
    for (const Luxel& luxel : luxels)
        columns.baked.push_back(luxel.baked);
    for (auto& half : columns.kinds)
        half.assign(luxels.size() * width, vec3(0));
    parallelFor(luxels.size(), [&](size_t i) {
        std::mt19937 random(static_cast<unsigned>(i));
        const Luxel& luxel = luxels[i];
        for (auto& half : columns.kinds)
            probe.lookByKind(samplePointOf(luxel), luxel.normal, kinds.lights, kRays, random,
                             std::span(half).subspan(i * width, width));
    });
    return columns;
}

/// Factors, none below 0, that make the least of the squared difference to the lightmap plus doubt x (factor - 1)^2.
class StrengthFit {
  public:
    StrengthFit(const Columns& columns, size_t width)
        : m_width(width)
        , m_products(width * width, 0)
        , m_wanted(width, 0) {
        double contrast = 0;
        std::vector<vec3> mean(width);
        for (size_t i = 0; i < columns.baked.size(); ++i) {
            contrast += glm::dot(columns.baked[i], columns.baked[i]);
            for (size_t k = 0; k < width; ++k) {
                const vec3 first = columns.kinds[0][i * width + k], second = columns.kinds[1][i * width + k];
                mean[k] = 0.5f * (first + second);
                // Noise of rays looks like light of which the lightmap has nothing. Added to what is wanted as to what
                // there is, it speaks for the script.
                m_wanted[k] += 0.25 * glm::dot(first - second, first - second);
            }
            for (size_t k = 0; k < width; ++k) {
                m_wanted[k] += glm::dot(columns.baked[i], mean[k]);
                for (size_t other = 0; other < width; ++other)
                    m_products[k * width + other] += glm::dot(mean[k], mean[other]);
            }
        }
        m_doubt = kDoubt * contrast;
    }

    std::vector<double> solve() const {
        std::vector<double> factors(m_width, 1);
        for (int round = 0; round < kRounds && m_doubt > 0; ++round)
            for (size_t k = 0; k < m_width; ++k) {
                double rest = m_wanted[k] + m_doubt;
                for (size_t other = 0; other < m_width; ++other)
                    if (other != k) rest -= m_products[k * m_width + other] * factors[other];
                factors[k] = std::max(0.0, rest / (m_products[k * m_width + k] + m_doubt));
            }
        return factors;
    }

  private:
    size_t m_width;
    std::vector<double> m_products, m_wanted;
    double m_doubt = 0;
};

} // namespace

std::vector<BakedStrength> estimateStrengths(const World& world, const MaterialLibrary& materials,
                                             const TextureLibrary& textures, const ProbeGeometry& geometry,
                                             const LightSet& lights) {
    const Kinds kinds = sortLights(world, materials, lights);
    std::vector<Luxel> luxels = sampleLuxels(world, materials, LuxelFaces::Lightmapped, kLuxels, 1);
    if (kinds.names.empty() || luxels.empty()) return {};
    LightAnimation animation(materials, textures);
    const LightTables tables = buildLightTables(world, materials, lights, {}, animation);
    Columns columns = traceColumns(world, LightProbe(world, geometry, tables), kinds, luxels);
    compareWithinGroups(luxels, kinds.names.size(), columns);
    const StrengthFit fit(columns, kinds.names.size());
    const std::vector<double> factors = fit.solve();
    std::vector<BakedStrength> strengths;
    for (size_t k = 0; k < kinds.names.size(); ++k) {
        // Not a number where a script's light is beyond all numbers.
        const bool changed = std::isfinite(factors[k]) && std::abs(factors[k] - 1) > kSureChange;
        strengths.push_back({kinds.names[k], changed ? static_cast<float>(factors[k]) : 1.0f});
    }
    return strengths;
}

void applyStrengths(const std::vector<BakedStrength>& strengths, const World& world, const MaterialLibrary& materials,
                    LightSet& lights) {
    std::map<std::string, float> factors;
    for (const BakedStrength& strength : strengths)
        factors[strength.name] = strength.factor < kLeastFactor ? 0.0f : strength.factor;
    const auto factorOf = [&](const std::string& name) {
        const auto found = factors.find(name);
        return found == factors.end() ? 1.0f : found->second;
    };
    for (TriangleLight& light : lights.triangles)
        light.radiance *= factorOf(nameOfSurface(world, materials, light.surface, false));
    for (SkyLight& sky : lights.skies)
        sky.radiosity *= factorOf(nameOfSurface(world, materials, sky.surface, sky.upperHemisphere));
    for (PointLight& light : lights.points)
        light.intensity *= factorOf(kEntities);
    for (size_t i = 0; i < lights.suns.size(); ++i)
        lights.suns[i].irradiance *= factorOf(nameOfSun(i));
    std::erase_if(lights.triangles, [](const TriangleLight& light) { return light.radiance == vec3(0); });
    std::erase_if(lights.skies, [](const SkyLight& sky) { return !(sky.radiosity > 0); });
    std::erase_if(lights.points, [](const PointLight& light) { return light.intensity == vec3(0); });
    std::erase_if(lights.suns, [](const SunLight& sun) { return sun.irradiance == vec3(0); });
}

} // namespace q3rt
