#include "renderer_rt/light_probe.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer_rt/surface_class.hpp"
#include "shaders/shared/constants.h"

namespace q3rt {

/// Light that comes along a line.
struct LightProbe::Flux {
    vec3 way{0};        ///< against the light, of any length
    vec3 across{0};     ///< irradiance of what faces it, luxel units
    float share = 1;    ///< of it, that arrives
    float faintest = 0; ///< irradiance at or below which a surface takes nothing
    vec3 takenBy(const vec3& normal) const;
};

namespace {

using namespace glm;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

#include "lib/light.glsl"
#include "lib/random.glsl"

ProbeWays waysAround(const vec3& axis) {
    const Frame frame = frameAround(axis);
    return {frame.normal, -frame.normal, frame.tangent, -frame.tangent, frame.bitangent, -frame.bitangent};
}

using Flux = LightProbe::Flux;

void addFlux(const Flux& flux, const ProbeWays& ways, ProbeWays& sum) {
    for (size_t k = 0; k < ways.size(); ++k)
        sum[k] += flux.takenBy(ways[k]);
}

Flux lookAtTriangle(const RtTriangleLight& light, const vec3& point, float u, float v) {
    Flux flux;
    const vec3 corner = light.corner - point;
    const float height = -dot(light.normal, corner);
    // A point in the light's own plane takes nothing from it.
    if (std::abs(height) <= light.error || (height < 0.0f && (light.flags & kLightTwoSided) == 0)) return flux;
    const SphericalTriangle seen =
        makeSphericalTriangle(corner, light.edge1, light.edge2, std::abs(height), light.areaQu2);
    flux.way = sampleSphericalTriangle(seen, u, v);
    if ((light.flags & kLightUpward) != 0 && flux.way.z <= 0.0f) return flux;
    flux.across = light.radiance * (2.0f * seen.halfAngle);
    flux.way += light.normal * (height > 0.0f ? light.error : -light.error); // short of the light's own surface
    // As isTriangleFaint() has it, but that a sample stands for the light's middle: far off they give the same.
    const vec3 middle = corner + (light.edge1 + light.edge2) / 3.0f;
    if (dot(middle, middle) > kFarTriangleSizes * kFarTriangleSizes * light.areaQu2) flux.faintest = light.faintest;
    return flux;
}

Flux lookAtPoint(const RtLight& light, const vec3& point) {
    const vec3 way = light.position - point;
    const float distance2 = std::max(dot(way, way), kLightMinDistanceQu * kLightMinDistanceQu);
    const float share = light.spot > 0.0f ? spotShare(light.axis, light.spot, -way) : 1.0f;
    return {way, light.power / distance2, share, light.faintest};
}

/// Of an alpha-tested surface, the share that is no hole: the mean alpha of its texture, whose texels are on the
/// device.
float coverShare(const MaterialLibrary& materials, MaterialId id) {
    for (const Stage& stage : materials.get(id).stages)
        if (stage.alphaTest != AlphaTest::None && !stage.unit[0].frames.empty()) {
            const float alpha = materials.textures().get(stage.unit[0].frames[0]).averageColor.a;
            return stage.alphaTest == AlphaTest::Less128 ? 1.0f - alpha : alpha;
        }
    return 1.0f;
}

/// Of [0, 1), another one at every place, always the same at one.
float numberOf(const vec2& place) {
    return unitFloat(hashPcg4d(uvec4(std::bit_cast<uint>(place.x), std::bit_cast<uint>(place.y), 0, 0)).x);
}

} // namespace

vec3 LightProbe::Flux::takenBy(const vec3& normal) const {
    if (share == 0.0f) return vec3(0.0f);
    const vec3 given = across * std::max(0.0f, dot(normal, glm::normalize(way)));
    return isFaint(given, faintest) ? vec3(0.0f) : share * given;
}

ProbeGeometry::ProbeGeometry(const World& world, const MaterialLibrary& materials)
    : m_farQu(2.0f * glm::length(world.bounds.maxs - world.bounds.mins)) {
    std::vector<vec3> positions;
    std::vector<uint8_t> opaque;
    const BspModel& model = world.bsp.models.front();
    for (int s = 0; s < model.surfaceCount; ++s) {
        const WorldSurface& surface = world.surfaces[static_cast<size_t>(model.firstSurface + s)];
        const auto surfaceClass = classifySurface(materials.get(surface.material));
        if (!surface.drawn || !surfaceClass || *surfaceClass == SurfaceClass::Layer) continue;
        for (uint32_t i = 0; i < surface.indexCount; ++i)
            positions.push_back(world.vertices[world.indices[surface.firstIndex + i]].position);
        m_isSky.resize(positions.size() / 3, *surfaceClass == SurfaceClass::Sky);
        const float cover = isOpaqueClass(*surfaceClass) ? 1.0f : coverShare(materials, surface.material);
        opaque.resize(positions.size() / 3, cover >= 1.0f);
        m_cover.resize(positions.size() / 3, cover);
    }
    m_tracer = std::make_unique<CpuTracer>(positions, opaque);
    m_tracer->accept = [this](uint32_t triangle, const vec2& at) { return numberOf(at) < m_cover[triangle]; };
}

bool ProbeGeometry::seesSky(const vec3& point, const vec3& direction) const {
    CpuHit hit;
    return m_tracer->closest(point, direction, 0.0f, m_farQu, hit) && m_isSky[hit.triangle];
}

const RtLightRow& LightProbe::rowAt(const vec3& point) const {
    const int cluster = m_world.clusterOf(point);
    return cluster >= 0 && cluster < m_world.bsp.clusterCount ? m_tables.rows.ofCluster(static_cast<size_t>(cluster))
                                                              : m_tables.rows.outside();
}

LightProbe::Seen LightProbe::look(const vec3& point, const vec3& axis, uint32_t rayCount, std::mt19937& random) const {
    const RtLightRow& row = rowAt(point);
    const ProbeWays ways = waysAround(axis);
    Seen seen;
    addRow(point, row, ways, rayCount, random, seen.irradiance);
    if (row.seesSky != 0) addSuns(point, ways, seen);
    return seen;
}

void LightProbe::lookByKind(const vec3& point, const vec3& normal, const Kinds& kinds, uint32_t rayCount,
                            std::mt19937& random, std::span<vec3> irradiance) const {
    std::ranges::fill(irradiance, vec3(0.0f));
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const RtLightRow& row = rowAt(point);
    const auto entries = std::span(m_tables.rows.entries).subspan(row.first, row.facing);
    std::vector<float> chance(kinds.count, 0.0f), next(kinds.count), passed(kinds.count, 0.0f);
    for (const RtLightEntry& entry : entries)
        chance[kinds.ofLight[entry.light]] += 1.0f / entry.weight;
    const float stratum = 1.0f / static_cast<float>(rayCount);
    for (float& at : next)
        at = stratum * uniform(random);
    // Each kind's rays are evenly apart in the sum of its lights' chances.
    for (const RtLightEntry& entry : entries) {
        const uint32_t kind = kinds.ofLight[entry.light];
        passed[kind] += 1.0f / entry.weight;
        for (; next[kind] * chance[kind] < passed[kind]; next[kind] += stratum) {
            const float u = uniform(random), v = uniform(random);
            irradiance[kind] +=
                traceSample(point, entry.light, u, v).takenBy(normal) * (entry.weight * chance[kind] * stratum);
        }
    }
    const size_t firstSun = m_tables.triangles.size() + m_tables.points.size();
    for (size_t s = 0; s < m_tables.others.size() && row.seesSky != 0; ++s) {
        const RtLight& sun = m_tables.others[s];
        if (dot(normal, sun.position) > 0.0f && m_geometry.seesSky(point, sun.position))
            irradiance[kinds.ofLight[firstSun + s]] += Flux{.way = sun.position, .across = sun.power}.takenBy(normal);
    }
}

LightProbe::Flux LightProbe::lookAt(const vec3& point, uint32_t light, float u, float v) const {
    return light < m_tables.triangles.size() ? lookAtTriangle(m_tables.triangles[light], point, u, v)
                                             : lookAtPoint(m_tables.points[light - m_tables.triangles.size()], point);
}

LightProbe::Arrival LightProbe::sample(const vec3& point, const vec3& normal, uint32_t light, float u, float v) const {
    const Flux flux = lookAt(point, light, u, v);
    const float given = lightWeight(flux.takenBy(normal));
    return {given, given > 0.0f && m_geometry.isFree(point, flux.way) ? given : 0.0f};
}

LightProbe::Flux LightProbe::traceSample(const vec3& point, uint32_t light, float u, float v) const {
    Flux flux = lookAt(point, light, u, v);
    if (flux.share != 0.0f && (isFaint(flux.across, flux.faintest) || !m_geometry.isFree(point, flux.way)))
        flux.share = 0.0f;
    return flux;
}

void LightProbe::addRow(const vec3& point, const RtLightRow& row, const ProbeWays& ways, uint32_t rayCount,
                        std::mt19937& random, ProbeWays& sum) const {
    if (row.facing == 0) return;
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const auto start = static_cast<uint32_t>(random());
    for (uint32_t i = 0; i < rayCount; ++i) {
        const DrawnLight drawn = drawLight(m_tables.rows, row, start + i * (~0u / rayCount));
        const float u = uniform(random), v = uniform(random);
        Flux flux = traceSample(point, drawn.light, u, v);
        flux.share *= drawn.weight / static_cast<float>(rayCount);
        if (flux.share != 0.0f) addFlux(flux, ways, sum);
    }
}

void LightProbe::addSuns(const vec3& point, const ProbeWays& ways, Seen& seen) const {
    float all = 0, arrived = 0;
    for (const RtLight& sun : m_tables.others) {
        all += lightWeight(sun.power);
        if (!m_geometry.seesSky(point, sun.position)) continue;
        arrived += lightWeight(sun.power);
        addFlux({.way = sun.position, .across = sun.power}, ways, seen.irradiance);
    }
    if (all > 0) seen.sunSeen = arrived / all;
}

} // namespace q3rt
