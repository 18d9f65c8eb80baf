#include "scene/luxels.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace q3rt {
namespace {

/// Where the ratio of traced to baked light says something, luxel units.
constexpr double kRatioThreshold = 25;

float largest(const vec3& color) { return std::max({color.x, color.y, color.z}); }

struct SampledTriangle {
    int surface;
    uint32_t firstIndex;
    double areaSum; ///< up to and including this one
};

bool hasLightmap(const World& world, int s) {
    const int page = world.bsp.surfaces[static_cast<size_t>(s)].lightmap;
    return page >= 0 && static_cast<size_t>(page) < world.bsp.lightmapPageCount();
}

bool hasVertexLight(const Material& material) {
    return std::any_of(material.stages.begin(), material.stages.end(),
                       [](const Stage& stage) { return stage.bakedLight == BakedLight::VertexColor; });
}

bool isLuxelSurface(const World& world, const MaterialLibrary& materials, LuxelFaces faces, int s) {
    const WorldSurface& surface = world.surfaces[static_cast<size_t>(s)];
    const Material& material = materials.get(surface.material);
    if (!surface.drawn || material.isSky || material.light.surfaceLight > 0) return false;
    if (hasLightmap(world, s)) return surface.type != BspSurfaceType::TriangleSoup;
    return faces == LuxelFaces::AllBaked && surface.patch < 0 && hasVertexLight(material);
}

std::vector<SampledTriangle> luxelTriangles(const World& world, const MaterialLibrary& materials, LuxelFaces faces) {
    std::vector<SampledTriangle> triangles;
    double areaSum = 0;
    const BspModel& model = world.bsp.models[0];
    for (int s = model.firstSurface; s < model.firstSurface + model.surfaceCount; ++s) {
        if (!isLuxelSurface(world, materials, faces, s)) continue;
        const WorldSurface& surface = world.surfaces[static_cast<size_t>(s)];
        for (uint32_t i = surface.firstIndex; i + 2 < surface.firstIndex + surface.indexCount; i += 3) {
            const vec3 &a = world.vertices[world.indices[i]].position,
                       &b = world.vertices[world.indices[i + 1]].position,
                       &c = world.vertices[world.indices[i + 2]].position;
            areaSum += 0.5 * glm::length(glm::cross(b - a, c - a));
            triangles.push_back({s, i, areaSum});
        }
    }
    return triangles;
}

/// Bilinear look-up in a lightmap page, clamped at its border; bytes 0..255.
vec3 luxelAt(const Bsp& bsp, int page, const vec2& st) {
    const uint8_t* texels = &bsp.lightmaps[static_cast<size_t>(page) * 3 * kLightmapSize * kLightmapSize];
    const auto texel = [&](int x, int y) {
        const size_t i = 3 * static_cast<size_t>(std::clamp(y, 0, kLightmapSize - 1) * kLightmapSize +
                                                 std::clamp(x, 0, kLightmapSize - 1));
        return vec3(texels[i], texels[i + 1], texels[i + 2]);
    };
    const vec2 at = glm::clamp(st, 0.0f, 1.0f) * static_cast<float>(kLightmapSize) - 0.5f;
    const vec2 cell = glm::floor(at), f = at - cell;
    const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y);
    return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), f.x), glm::mix(texel(x, y + 1), texel(x + 1, y + 1), f.x),
                    f.y);
}

/// As the file has it: the world's own vertices are brightened, and saturate.
vec3 vertexLightAt(const World& world, int s, uint32_t vertex) {
    const auto surface = static_cast<size_t>(s);
    const uint32_t number = vertex - world.surfaces[surface].firstVertex;
    const auto& color = world.bsp.vertices[static_cast<size_t>(world.bsp.surfaces[surface].firstVertex) + number].color;
    return {color.x, color.y, color.z};
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

LuxelReport summarise(const std::vector<Luxel>& luxels, const std::vector<DirectLight>& traced) {
    LuxelReport report;
    report.pointCount = luxels.size();
    if (luxels.empty()) return report;
    const auto n = static_cast<double>(luxels.size());
    double sumTT = 0, sumBB = 0, sumTB = 0, sumMin = 0;
    std::vector<double> ratios;
    for (size_t i = 0; i < luxels.size(); ++i) {
        const double t = largest(traced[i].total()), b = largest(luxels[i].baked);
        report.meanTraced += t / n;
        report.meanBaked += b / n;
        report.meanSurfaces += largest(traced[i].surfaces) / n;
        report.meanSun += largest(traced[i].suns) / n;
        report.meanSky += largest(traced[i].sky) / n;
        report.meanPoints += largest(traced[i].points) / n;
        sumTT += t * t;
        sumBB += b * b;
        sumTB += t * b;
        sumMin += std::min(t, b);
        if (t > kRatioThreshold && b > 0) ratios.push_back(t / b);
    }
    const double covariance = sumTB / n - report.meanTraced * report.meanBaked;
    const double varianceT = sumTT / n - report.meanTraced * report.meanTraced;
    const double varianceB = sumBB / n - report.meanBaked * report.meanBaked;
    if (varianceT > 0 && varianceB > 0) {
        report.correlation = covariance / std::sqrt(varianceT * varianceB);
        report.slope = covariance / varianceB;
    }
    if (report.meanBaked > 0) report.explainedShare = sumMin / (n * report.meanBaked);
    report.medianRatio = median(std::move(ratios));
    return report;
}

} // namespace

vec3 normalAt(const World& world, uint32_t firstIndex, const vec3& weight) {
    const auto corner = [&](uint32_t k) -> const Vertex& { return world.vertices[world.indices[firstIndex + k]]; };
    vec3 normal = weight.x * corner(0).normal + weight.y * corner(1).normal + weight.z * corner(2).normal;
    if (normal == vec3(0))
        normal = glm::cross(corner(2).position - corner(0).position, corner(1).position - corner(0).position);
    const float length = glm::length(normal);
    return length > 0 ? normal / length : vec3(0);
}

std::vector<Luxel> sampleLuxels(const World& world, const MaterialLibrary& materials, LuxelFaces faces, size_t count,
                                uint32_t seed) {
    std::vector<Luxel> luxels;
    const std::vector<SampledTriangle> triangles = luxelTriangles(world, materials, faces);
    if (triangles.empty()) return luxels;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> area(0, triangles.back().areaSum);
    std::uniform_real_distribution<float> unit(0, 1);
    // Saturated luxels are drawn and left out, so the number that comes back may be smaller.
    for (size_t i = 0; i < count; ++i) {
        const auto it = std::lower_bound(triangles.begin(), triangles.end(), area(random),
                                         [](const SampledTriangle& t, double a) { return t.areaSum < a; });
        const float root = std::sqrt(unit(random)), v = unit(random);
        const float weight[3] = {1 - root, root * (1 - v), root * v};
        Luxel luxel;
        vec2 st(0);
        const bool mapped = hasLightmap(world, it->surface);
        for (uint32_t corner = 0; corner < 3; ++corner) {
            const uint32_t number = world.indices[it->firstIndex + corner];
            const Vertex& vertex = world.vertices[number];
            luxel.position += weight[corner] * vertex.position;
            st += weight[corner] * vertex.lightmapSt;
            if (!mapped) luxel.baked += weight[corner] * vertexLightAt(world, it->surface, number);
        }
        luxel.normal = normalAt(world, it->firstIndex, {weight[0], weight[1], weight[2]});
        luxel.surface = it->surface;
        if (mapped) luxel.baked = luxelAt(world.bsp, world.bsp.surfaces[static_cast<size_t>(it->surface)].lightmap, st);
        if (luxel.normal == vec3(0) || largest(luxel.baked) >= 255) continue;
        luxels.push_back(luxel);
    }
    return luxels;
}

double luxelAreaQu2(const World& world, const MaterialLibrary& materials, LuxelFaces faces) {
    const std::vector<SampledTriangle> triangles = luxelTriangles(world, materials, faces);
    return triangles.empty() ? 0 : triangles.back().areaSum;
}

LuxelReport checkLuxels(const World& world, const MaterialLibrary& materials, const LightSet& lights, size_t count,
                        uint32_t seed, const std::function<void()>& mayGoOn) {
    const std::vector<Luxel> luxels = sampleLuxels(world, materials, LuxelFaces::Lightmapped, count, seed);
    const DirectLightTracer tracer(world, materials, lights);
    std::vector<DirectLight> traced(luxels.size());
    parallelFor(luxels.size(), [&](size_t i) {
        if (mayGoOn) mayGoOn();
        std::mt19937 random(seed + 1 + static_cast<uint32_t>(i));
        traced[i] = tracer.at(samplePointOf(luxels[i]), luxels[i].normal, {}, random);
    });
    return summarise(luxels, traced);
}

} // namespace q3rt
