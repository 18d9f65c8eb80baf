#include "map_lights.hpp"

#include <algorithm>
#include <random>

#include "renderer_rt/row_sight.hpp"
#include "renderer_rt/surface_class.hpp"

namespace q3rt::test {

namespace {

bool blocksLight(const Material& material) {
    const auto surfaceClass = classifySurface(material);
    return surfaceClass == SurfaceClass::Solid || surfaceClass == SurfaceClass::SolidTwoSided ||
           surfaceClass == SurfaceClass::Sky;
}

} // namespace

MapLights::MapLights(FileSource& files, const std::string& map)
    : m_textures(files, {})
    , m_materials(files, m_textures, {})
    , m_world(q3rt::loadWorld(files, "maps/" + map + ".bsp", m_materials, {})) {
    const LightSet lights = extractLights(*m_world, m_materials);
    LightAnimation animation(m_materials, m_textures);
    m_tables = buildLightTables(*m_world, m_materials, lights, {}, animation);
    lookFromRows(LightProbe(*m_world, ProbeGeometry(*m_world, m_materials), m_tables), m_tables.rows);
    m_colors = animation.evaluate(0);
    const BspModel& model = m_world->bsp.models[0];
    std::vector<vec3> positions;
    for (int s = model.firstSurface; s < model.firstSurface + model.surfaceCount; ++s) {
        const WorldSurface& surface = m_world->surfaces[static_cast<size_t>(s)];
        if (!surface.drawn || !blocksLight(m_materials.drawn(surface.material))) continue;
        for (uint32_t i = 0; i + 2 < surface.indexCount; i += 3) {
            m_firstIndex.push_back(surface.firstIndex + i);
            m_isSky.push_back(m_materials.drawn(surface.material).isSky);
            for (uint32_t k = 0; k < 3; ++k)
                positions.push_back(m_world->vertices[m_world->indices[surface.firstIndex + i + k]].position);
        }
    }
    m_tracer = std::make_unique<CpuTracer>(positions);
    m_farQu = 2 * glm::length(m_world->bounds.maxs - m_world->bounds.mins);
}

std::vector<RtPixel> MapLights::pickPoints(size_t count) const {
    std::vector<double> areaSum;
    const auto vertexOf = [&](size_t triangle, size_t k) -> const Vertex& {
        return m_world->vertices[m_world->indices[m_firstIndex[triangle] + k]];
    };
    double sum = 0;
    for (size_t t = 0; t < m_firstIndex.size(); ++t) {
        const dvec3 a(vertexOf(t, 0).position), b(vertexOf(t, 1).position), c(vertexOf(t, 2).position);
        if (!m_isSky[t]) sum += 0.5 * glm::length(glm::cross(b - a, c - a));
        areaSum.push_back(sum);
    }
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<RtPixel> points;
    while (points.size() < count) {
        const auto found = std::upper_bound(areaSum.begin(), areaSum.end(), uniform(random) * sum);
        const auto t = std::min(static_cast<size_t>(found - areaSum.begin()), areaSum.size() - 1);
        vec2 weights(uniform(random), uniform(random));
        if (weights.x + weights.y > 1) weights = 1.0f - weights;
        const vec3 corner[3] = {vertexOf(t, 0).position, vertexOf(t, 1).position, vertexOf(t, 2).position};
        const vec3 facing = glm::cross(corner[2] - corner[0], corner[1] - corner[0]);
        if (!(glm::length(facing) > 0)) continue;
        const vec3 geometric = glm::normalize(facing);
        const vec3 blend = vertexOf(t, 0).normal * (1 - weights.x - weights.y) + vertexOf(t, 1).normal * weights.x +
                           vertexOf(t, 2).normal * weights.y;
        const vec3 shading = glm::length(blend) > 0 ? glm::normalize(blend) : geometric;
        points.push_back(makeLitPixel(corner, weights, shading, geometric));
    }
    return points;
}

bool MapLights::isVisible(const vec3& origin, const vec3& direction) const {
    return !m_tracer->occluded(origin, direction, 1.0f);
}

bool MapLights::reachesSky(const vec3& origin, const vec3& direction) const {
    CpuHit hit;
    return m_tracer->closest(origin, direction, 0.0f, 1.0f, hit) && m_isSky[hit.triangle];
}

RtFrame MapLights::describeFrame() const {
    const auto address = [](const auto& table) { return reinterpret_cast<uint64_t>(table.data()); };
    RtFrame frame{};
    frame.triangleLights = address(m_tables.triangles);
    frame.lightColors = address(m_colors);
    frame.pointLights = address(m_tables.points);
    frame.lightRows = address(m_tables.rows.rows);
    frame.lightEntries = address(m_tables.rows.entries);
    frame.lights = address(m_tables.others);
    frame.nodes = address(m_tables.nodes);
    frame.triangleLightCount = static_cast<uint>(m_tables.triangles.size());
    frame.pointLightCount = static_cast<uint>(m_tables.points.size());
    frame.lightCount = static_cast<uint>(m_tables.others.size());
    frame.clusterCount = clusterCount();
    frame.flags = kFrameIllumination | kFrameSoftShadows;
    frame.farQu = m_farQu;
    return frame;
}

} // namespace q3rt::test
